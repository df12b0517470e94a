# SPDX-License-Identifier: Apache-2.0
"""Networks against PyTorch, and their ONNX files against ONNX Runtime: network_check.py RUN_NETWORK"""
import importlib.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))
from run_cases import Skip, case, run_cases

RUN_NETWORK = pathlib.Path(sys.argv[1]).resolve()
NODE_MODULES = pathlib.Path(os.environ.get("KINALIGN_NODE_MODULES", ROOT / "build/npm/node_modules"))
FRAMES = (0, 1, 2, 3, 7, 50, 103)


def torch_networks():
    if not importlib.util.find_spec("torch"):
        raise Skip("needs python3-torch")
    import torch_networks as module
    return module


def run_network(how, kernels, model, frames_path, out):
    done = subprocess.run([RUN_NETWORK, how, kernels, model, frames_path, out], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return out


def assert_same(found, expected, what):
    """To 1e-5 of the largest value, or of 1."""
    import numpy
    assert found.size == expected.size, f"{what}: {found.size} values, not {expected.size}"
    if found.size:
        error = numpy.abs(found.reshape(expected.shape) - expected).max() / max(1.0, numpy.abs(expected).max())
        assert error < 1e-5, f"{what}: {error}"


def compare(networks, folder, model, seed, online):
    """One network over sequences of several lengths, whole and frame by frame, by both builds of the kernels."""
    import numpy
    path, values = folder / "model.safetensors", folder / "in"
    model.save(path)
    for frames in (FRAMES[seed % len(FRAMES)], 30):
        given = networks.random_frames(seed, frames, model.architecture["inputs"])
        given.tofile(values)
        expected = model(given) if frames else numpy.zeros((0, model.outputs), numpy.float32)
        for how in ("offline", "online") if online else ("offline",):
            for kernels in ("baseline", "best"):
                found = numpy.fromfile(run_network(how, kernels, path, values, folder / "out"), numpy.float32)
                assert_same(found, expected, f"seed {seed}, {frames} frames, {how}, {kernels}, {model.architecture}")


@case
def every_kind_of_layer_agrees_with_PyTorch(folder):
    networks = torch_networks()
    for seed, kind in enumerate(networks.KINDS):
        for online in (False, True) if kind not in ("max_pool", "along_time") else (False,):
            compare(networks, folder, networks.model_with(kind, seed, online), seed, online)


@case
def random_networks_agree_with_PyTorch(folder):
    networks = torch_networks()
    for seed in range(40):
        online = seed % 2 == 0
        compare(networks, folder, networks.random_model(seed, online), seed, online)


def onnx_files(networks, folder):
    """Models of every kind of layer and mixed ones, as ONNX, with input and expected output by name."""
    models = [networks.model_with(kind, seed, False) for seed, kind in enumerate(networks.KINDS)]
    models += [networks.random_model(seed, False) for seed in range(20)]
    for i, model in enumerate(models):
        model.save(folder / "model.safetensors")
        run_network("onnx", "best", folder / "model.safetensors", "-", folder / f"{i}.onnx")
        given = networks.random_frames(i, FRAMES[1 + i % (len(FRAMES) - 1)], model.architecture["inputs"])
        given.tofile(folder / f"{i}.in")
        yield f"{i}:{len(given)}", model(given), model.architecture


@case
def the_ONNX_checker_accepts_every_kind_of_layer(folder):
    networks = torch_networks()
    if not importlib.util.find_spec("onnx"):
        raise Skip("needs python3-onnx")
    import onnx
    for name, _, architecture in onnx_files(networks, folder):
        model = onnx.load(str(folder / f"{name.split(':')[0]}.onnx"))
        onnx.checker.check_model(model, full_check=True)
        assert [(o.domain, o.version) for o in model.opset_import] == [("", 13)], architecture
        assert [(m.key, m.value) for m in model.metadata_props] == [("made by", "a test")], architecture


@case
def ONNX_Runtime_computes_what_PyTorch_does(folder):
    import numpy
    networks = torch_networks()
    if not shutil.which("node") or not (NODE_MODULES / "onnxruntime-node").is_dir():
        raise Skip("needs node and npm's onnxruntime-node")
    models = list(onnx_files(networks, folder))
    done = subprocess.run(["node", ROOT / "tests/witness/onnx_runtime.mjs", NODE_MODULES, folder, *[m[0] for m in models]],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    for line, (name, expected, architecture) in zip(done.stdout.splitlines(), models, strict=True):
        assert json.loads(line) == [["input"], ["output"], [1, *expected.shape]], line
        found = numpy.fromfile(folder / f"{name.split(':')[0]}.out", numpy.float32)
        assert_same(found, expected, f"{name}, {architecture}")


@case
def the_reader_of_the_page_reads_a_model_that_kinalign_wrote(folder):
    import numpy
    networks = torch_networks()
    code = re.search(r"```python\n(.*?)```", (ROOT / "docs/formats/model.md").read_text(encoding="utf-8"), re.S)[1]
    page = {}
    exec(code, page)  # pylint: disable=exec-used
    model = networks.random_model(1, False)
    model.save(folder / "model.safetensors")
    copy = run_network("copy", "best", folder / "model.safetensors", "-", folder / "copy.safetensors")
    tensors, metadata = page["read_model"](copy)
    expected = model.tensors()
    assert json.loads(metadata["architecture"]) == model.architecture
    assert tensors.keys() == expected.keys()
    assert all(numpy.array_equal(tensors[name], expected[name]) for name in expected)


sys.exit(run_cases("kinalign network ", sys.argv[2:]))
