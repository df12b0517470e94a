# SPDX-License-Identifier: Apache-2.0
"""Networks of kinalign/infer/architecture.h in PyTorch: random ones, and their SafeTensors files."""
import json
import random
import struct

import numpy
import torch

torch.set_num_threads(1)

ELEMENTWISE = {"relu": torch.nn.ReLU(), "gelu": torch.nn.GELU(), "tanh": torch.nn.Tanh(), "sigmoid": torch.nn.Sigmoid()}
TIMELESS = ["linear", "layer_norm", "relu", "leaky_relu", "gelu", "tanh", "sigmoid", "dropout", "slice"]
RECURRENT = ["lstm", "gru"]
BRANCHED = ["sum", "product", "concat"]
KINDS = TIMELESS + ["conv"] + RECURRENT + BRANCHED + ["max_pool", "along_time"]


def write_safetensors(path, tensors, metadata):
    header, at = {"__metadata__": metadata}, 0
    for name, values in tensors.items():
        size = 4 * values.size
        header[name] = {"dtype": "F32", "shape": list(values.shape), "data_offsets": [at, at + size]}
        at += size
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    with open(path, "wb") as out:
        out.write(struct.pack("<Q", len(text)) + text)
        for values in tensors.values():
            out.write(values.astype("<f4").tobytes())


class Model:
    """Modules of an architecture by their paths, and the network as a function."""

    def __init__(self, architecture):
        self.architecture = architecture
        self.modules = {}
        self.outputs = self._make(architecture["layers"], architecture["inputs"], "")

    def _make(self, layers, channels, path):
        for i, layer in enumerate(layers):
            place, kind, out = f"{path}{i}", layer["kind"], layer.get("out")
            module = None
            if kind == "linear":
                module = torch.nn.Linear(channels, out)
            elif kind == "conv":
                module = torch.nn.Conv1d(channels, out, layer["kernel"], dilation=layer["dilation"])
            elif kind in RECURRENT:
                make = {"lstm": torch.nn.LSTM, "gru": torch.nn.GRU}[kind]
                module = make(channels, out, batch_first=True, bidirectional=layer["bidirectional"])
                out *= 2 if layer["bidirectional"] else 1
            elif kind == "layer_norm":
                module = torch.nn.LayerNorm(channels)
                torch.nn.init.normal_(module.weight)
                torch.nn.init.normal_(module.bias)
            elif kind == "along_time":
                self._make(layer["branches"][0], layer["window"], f"{place}.0.")
            elif kind in BRANCHED:
                behind = [self._make(b, channels, f"{place}.{j}.") for j, b in enumerate(layer["branches"])]
                out = sum(behind) if kind == "concat" else behind[0]
            if module:
                self.modules[place] = module.eval()
            channels = out or channels
        return channels

    def tensors(self):
        return {f"{path}.{name}": values.detach().numpy() for path, module in self.modules.items()
                for name, values in module.state_dict().items()}

    def save(self, path):
        write_safetensors(path, self.tensors(), {"architecture": json.dumps(self.architecture)})

    def __call__(self, values):
        """[T,inputs] to [T,outputs], NumPy."""
        with torch.no_grad():
            return self._run(self.architecture["layers"], torch.from_numpy(values)[None], "", [])[0].numpy()

    def _run(self, layers, x, path, pools):
        for i, layer in enumerate(layers):
            x = self._one(layer, x, f"{path}{i}", pools)
        return x

    def _one(self, layer, x, place, pools):
        kind = layer["kind"]
        if kind == "conv":
            reach = (layer["kernel"] - 1) * layer["dilation"]
            before = reach if layer["causal"] else reach // 2
            padded = torch.nn.functional.pad(x.transpose(1, 2), (before, reach - before))
            return self.modules[place](padded).transpose(1, 2)
        if kind in RECURRENT:
            return self.modules[place](x)[0]
        if kind in ("linear", "layer_norm"):
            return self.modules[place](x)
        if kind in ELEMENTWISE:
            return ELEMENTWISE[kind](x)
        if kind == "leaky_relu":
            return torch.nn.functional.leaky_relu(x, layer["slope"])
        if kind == "slice":
            return x[:, :, layer["begin"]:layer["begin"] + layer["out"]]
        if kind == "max_pool":
            pools.append(x.shape[1])
            return torch.nn.functional.max_pool1d(x.transpose(1, 2), 2, ceil_mode=True).transpose(1, 2)
        if kind == "unpool":
            return 0.5 * x.repeat_interleave(2, dim=1)[:, :pools.pop()]
        if kind == "dropout":
            return x
        if kind == "along_time":
            return self._along_time(layer, x, place)
        results = [self._run(b, x, f"{place}.{j}.", []) for j, b in enumerate(layer["branches"])]
        if kind == "concat":
            return torch.cat(results, dim=2)
        return sum(results) if kind == "sum" else torch.stack(results).prod(dim=0)


    def _along_time(self, layer, x, place):
        """The mean over all windows that a frame lies in, window by window."""
        frames, window = x.shape[1], layer["window"]
        if frames == 0:
            return x
        x = torch.cat([x, x[:, -1:].expand(-1, max(0, window - frames), -1)], dim=1)
        total, count = torch.zeros_like(x), torch.zeros_like(x)
        for begin in range(x.shape[1] - window + 1):
            rows = x[:, begin:begin + window].transpose(1, 2)
            total[:, begin:begin + window] += self._run(layer["branches"][0], rows, f"{place}.0.", []).transpose(1, 2)
            count[:, begin:begin + window] += 1
        return (total / count)[:, :frames]


def layer_of(kind, channels, online, rng):
    """A random layer that gets `channels`, and the channels behind it."""
    layer, out = {"kind": kind}, rng.randint(1, 40)
    if kind in ("linear", "conv") + tuple(RECURRENT):
        layer["out"] = out
    if kind == "conv":
        causal = online or rng.random() < 0.5
        kernel = rng.randint(1, 6) if causal else rng.choice([1, 3, 5, 7])
        layer |= {"kernel": kernel, "dilation": rng.randint(1, 5), "causal": causal}
    elif kind in RECURRENT:
        layer["bidirectional"] = not online and rng.random() < 0.5
        out *= 2 if layer["bidirectional"] else 1
    elif kind == "slice":
        layer["begin"] = rng.randint(0, channels - 1)
        layer["out"] = out = rng.randint(1, channels - layer["begin"])
    elif kind != "linear":
        out = channels
    if kind == "leaky_relu":
        layer["slope"] = 0.125
    if kind == "dropout":
        layer["rate"] = 0.5
    return layer, out


def along_time(rng):
    window, branch = rng.randint(1, 20), []
    channels = window
    for kind in rng.choices(TIMELESS, k=rng.randint(0, 3)):
        layer, channels = layer_of(kind, channels, True, rng)
        branch.append(layer)
    return {"kind": "along_time", "window": window, "branches": [branch + [{"kind": "linear", "out": window}]]}


def branched(kind, channels, online, rng, depth):
    branches, behind = [], []
    for _ in range(rng.randint(1, 3)):
        branch, out = layers_of(rng.randint(0, 3), channels, online, rng, depth + 1)
        if kind != "concat" and out != channels:
            branch, out = branch + [{"kind": "linear", "out": channels}], channels
        branches.append(branch)
        behind.append(out)
    return {"kind": kind, "branches": branches}, sum(behind) if kind == "concat" else channels


def layers_of(count, channels, online, rng, depth=0):
    layers = []
    for _ in range(count):
        kind = rng.choice(TIMELESS + ["conv", "conv"] + RECURRENT + (BRANCHED if depth < 2 else []) +
                          ([] if online else ["pools", "along_time"]))
        if kind == "pools":
            inner, channels = layers_of(rng.randint(0, 2), channels, online, rng, 2)
            layers += [{"kind": "max_pool"}, *inner, {"kind": "unpool"}]
        elif kind == "along_time":
            layers.append(along_time(rng))
        else:
            make = branched if kind in BRANCHED else layer_of
            layer, channels = make(kind, channels, online, rng, *([depth] if kind in BRANCHED else []))
            layers.append(layer)
    return layers, channels


def model_with(kind, seed, online):
    """A layer of a kind between two linear ones; with max_pool its unpool."""
    rng = random.Random(seed)
    torch.manual_seed(seed)
    inputs = rng.randint(2, 40)
    layers = [{"kind": "max_pool"}, {"kind": "linear", "out": inputs}, {"kind": "unpool"}]
    if kind == "along_time":
        layers = [along_time(rng)]
    elif kind != "max_pool":
        make = branched if kind in BRANCHED else layer_of
        layers = [make(kind, inputs, online, rng, *([1] if kind in BRANCHED else []))[0]]
    ends = {"kind": "linear", "out": inputs}
    return Model({"inputs": inputs, "layers": [ends, *layers, ends]})


def random_model(seed, online):
    rng = random.Random(seed)
    torch.manual_seed(seed)
    inputs = rng.randint(1, 40)
    layers, _ = layers_of(rng.randint(1, 6), inputs, online, rng)
    return Model({"inputs": inputs, "layers": layers})


def random_frames(seed, frames, channels):
    return numpy.random.default_rng(seed).standard_normal((frames, channels)).astype(numpy.float32)
