# SPDX-License-Identifier: Apache-2.0
"""The program that trains: its files as others read them, and its models in PyTorch.
learn_check.py KINALIGN_LEARN RUN_DENOISER [CASE...]"""
import hashlib
import importlib.util
import json
import os
import pathlib
import signal
import struct
import subprocess
import sys
import time

import numpy
from scipy.signal import savgol_filter

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests/infer")]
from run_cases import Skip, case, in_time, run_cases

LEARN, RUN_DENOISER = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
REFERENCE_BLAS = pathlib.Path("/usr/lib/x86_64-linux-gnu/blas")
JOINTS = ["SpineBase", "SpineMid", "SpineShoulder", "Head", "ShoulderLeft", "ElbowLeft", "ShoulderRight", "ElbowRight",
          "HipLeft", "KneeLeft", "AnkleLeft", "FootLeft", "HipRight", "KneeRight", "AnkleRight", "FootRight"]
BODY = numpy.array([[0, .95, 0], [0, 1.2, 0], [0, 1.4, 0], [0, 1.65, .04], [.18, 1.4, 0], [.24, 1.12, .02], [-.18, 1.4, 0],
                    [-.24, 1.12, .02], [.1, .92, 0], [.11, .5, .02],
                    [.11, .09, 0], [.11, .04, .12], [-.1, .92, 0], [-.11, .5, .02], [-.11, .09, 0], [-.11, .04, .12]])


def moving(frames, seed):
    """[T,J,3]: a body that turns once and whose joints wave."""
    rng = numpy.random.default_rng(seed)
    times = numpy.arange(frames)[:, None, None]
    body = BODY + .05 * numpy.sin(rng.uniform(0, 6, BODY.shape) + .1 * times)
    angle = 2 * numpy.pi * numpy.arange(frames) / frames
    turn = numpy.zeros((frames, 3, 3))
    turn[:, 0, 0] = turn[:, 2, 2] = numpy.cos(angle)
    turn[:, 0, 2], turn[:, 2, 0], turn[:, 1, 1] = numpy.sin(angle), -numpy.sin(angle), 1
    return (body @ turn.transpose(0, 2, 1) + [1, 0, 3]).astype("<f4")


def windows(path, frames=70, length=70):
    """Two takes of two people, one window each."""
    facts = {"schema": "kinalign.windows/1", "dataset": "waves", "licence": "CC0-1.0", "citation": "none", "rate_hz": 30,
             "parts": ["train", "validation"],
             "takes": [{"name": f"S0{i}-A1", "subject": f"S0{i}", "action": "A1"} for i in (1, 2)],
             "streams": [{"name": name, "kind": "points", "names": JOINTS} for name in ("mocap", "kinect")]}
    arrays = {"take": [0, 1], "part": [0, 1], "first": [0, 0], "rows": [frames, frames],
              "time_ns": [0, 0]}
    flat = {name: numpy.stack([moving(length, seed + k).reshape(length, -1) for k in (0, 1)])
            for name, seed in (("mocap", 10), ("kinect", 20))}
    numpy.savez(path, **{name: numpy.array(values, "<i8") for name, values in arrays.items()},
                **{f"{name}_positions": values for name, values in flat.items()}, manifest=numpy.array(json.dumps(facts)))


def job(folder, method, **more):
    """A job of two steps; its file."""
    if not (folder / "w.npz").exists():
        windows(folder / "w.npz")
    options = {"steps": 2, "seed": 1} | more.pop("options", {})
    words = {"schema": "kinalign.training_job/1", "method": method, "windows": str(folder / "w.npz"), "input": "kinect",
             "truth": "mocap", "out": str(folder / "m.safetensors"), "log": str(folder / "run/log.csv"),
             "checkpoint": str(folder / "run/checkpoint"), "identity": method, "options": options} | more
    (folder / "run").mkdir(exist_ok=True)
    (folder / "job.json").write_text(json.dumps(words))
    return folder / "job.json"


def learn(path, env=None):
    """Exit code, lines."""
    done = subprocess.run([LEARN, path], capture_output=True, text=True, check=False, env={**os.environ, **(env or {})},
                          timeout=300)
    return done.returncode, [json.loads(line) for line in done.stdout.splitlines()]


def trained(path):
    code, lines = learn(path)
    assert code == 0, lines
    return lines[-1]


def read_model(path):
    bytes_of = path.read_bytes()
    end = 8 + struct.unpack("<Q", bytes_of[:8])[0]
    header = json.loads(bytes_of[8:end])
    model = json.loads(header.pop("__metadata__")["kinalign"])
    tensors = {name: numpy.frombuffer(bytes_of[end:][slice(*one["data_offsets"])], "<f4").reshape(one["shape"])
               for name, one in header.items()}
    return model, tensors


@case
def a_run_leaves_a_model_a_log_and_no_checkpoint(folder):
    last = trained(job(folder, "refine", options={"steps": 3, "judge_every": 1}))
    assert last["written"] == str(folder / "m.safetensors") and last["loss"] > 0 and last["judgement"] > 0, last
    model, _ = read_model(folder / "m.safetensors")
    assert model["task"] == "denoise" and model["method"] == "refine", model
    data, = model["training"]["data"]
    hashed = hashlib.sha256((folder / "w.npz").read_bytes()).hexdigest()
    assert data == {"name": "waves", "licence": "CC0-1.0", "citation": "none", "windows_sha256": hashed, "stretches": 1,
                    "frames": 70, "subjects": ["S01"]}, data
    assert model["software"].startswith("kinalign "), model["software"]
    assert model["training"]["steps"] == 3 and model["training"]["seed"] == 1, model["training"]
    log = (folder / "run/log.csv").read_text().splitlines()
    assert log[0] == "step,loss,rate,gradient,judgement" and [line.split(",")[0] for line in log[1:]] == ["1", "2", "3"], log
    assert not (folder / "run/checkpoint").exists()


def crc32c(data):
    crc = 0xffffffff
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82f63b78 if crc & 1 else 0)
    return crc ^ 0xffffffff


def records(data):
    """Records of TensorBoard's file, whose checksums are checked."""
    while data:
        size, = struct.unpack("<Q", data[:8])
        for part, check in ((data[:8], data[8:12]), (data[12:12 + size], data[12 + size:16 + size])):
            crc = crc32c(part)
            masked = ((crc >> 15 | crc << 17) + 0xa282ead8) & 0xffffffff
            assert struct.pack("<I", masked) == check, "a wrong checksum"
        yield data[12:12 + size]
        data = data[16 + size:]


def fields(message):
    """Number and value of each field of a protobuf message."""
    at = 0

    def varint():
        nonlocal at
        value = shift = 0
        while True:
            value |= (message[at] & 127) << shift
            at, shift = at + 1, shift + 7
            if message[at - 1] < 128:
                return value
    while at < len(message):
        tag = varint()
        if tag & 7 == 0:
            yield tag >> 3, varint()
        else:
            size = {1: 8, 5: 4}.get(tag & 7) or varint()
            yield tag >> 3, message[at:at + size]
            at += size


@case
def TensorBoard_s_file_has_true_checksums_and_the_numbers_of_the_log(folder):
    trained(job(folder, "refine", options={"steps": 3, "judge_every": 1}))
    path, = (folder / "run").glob("events.out.tfevents.*")
    version, *events = [dict(fields(one)) for one in records(path.read_bytes())]
    assert version[3] == b"brain.Event:2", version
    told = {}
    for event in events:
        one = dict(fields(dict(fields(event[5]))[1]))
        told[event[2], one[1].decode()] = struct.unpack("<f", one[2])[0]
    names, *rows = [line.split(",") for line in (folder / "run/log.csv").read_text().splitlines()]
    assert len(told) == sum(len(row) - 1 for row in rows), told
    for row in rows:
        for name, value in zip(names[1:], row[1:], strict=True):
            assert abs(told[int(row[0]), name] - float(value)) <= 1e-5 * abs(float(value)), (row, name)


def seen(model, tensors, body):
    """What a network sees of [T,J,3]: features and base [T,K,3] in the body's frame, its turn and root, the smoothed body."""
    joints, frames = model["input"]["joints"], len(body)
    how = model["input"]["smoothing"]
    smooth = savgol_filter(body, how["window"], how["order"], axis=0, mode="interp")
    at = joints.index
    left = smooth[:, at("HipLeft")] - smooth[:, at("HipRight")] + smooth[:, at("ShoulderLeft")] - smooth[:, at("ShoulderRight")]
    left = left[:, [0, 2]] / numpy.linalg.norm(left[:, [0, 2]], axis=1, keepdims=True)
    turn = numpy.zeros((frames, 3, 3))
    turn[:, 0, 0] = turn[:, 2, 2] = left[:, 0]
    turn[:, 0, 2], turn[:, 2, 0], turn[:, 1, 1] = left[:, 1], -left[:, 1], 1
    root = smooth[:, [at("SpineBase")]]
    inside, smooth_inside = ((x - root) @ turn.transpose(0, 2, 1) for x in (body, smooth))
    steps = numpy.diff(inside, axis=0, prepend=inside[:1])
    features = numpy.concatenate([inside.reshape(frames, -1), steps.reshape(frames, -1), numpy.ones((frames, len(joints)))], 1)
    features = (features - tensors["input.mean"]) / tensors["input.scale"]
    base = numpy.stack([smooth_inside[:, b] if b >= 0 else numpy.zeros((frames, 3)) for b in model["output"]["bases"]], 1)
    return features.astype(numpy.float32), base, turn, root, smooth


def answered(model, tensors, network_of, body):
    """What a model answers to [T,J,3], with NumPy, SciPy and PyTorch."""
    features, base, turn, root, _ = seen(model, tensors, body)
    out = network_of("net")(features)
    count, frames = len(model["output"]["joints"]), len(body)
    answer = base.reshape(frames, -1) + tensors["answer.mean"] + model["output"]["scale_m"] * out[:, :3 * count]
    if "second" in model["networks"]:
        answer = network_of("second")(answer.astype(numpy.float32))
    return answer.reshape(frames, count, 3) @ turn + root


@case
def a_model_answers_in_PyTorch_what_the_program_answers(folder):
    if not importlib.util.find_spec("torch"):
        raise Skip("needs python3-torch")
    import torch
    import torch_networks
    for method in ("refine", "cnn", "cnn-manifold", "bra-p", "smoothnet"):
        trained(job(folder, method))
        model, tensors = read_model(folder / "m.safetensors")

        def network_of(name, model=model, tensors=tensors):
            network = torch_networks.Model(model["networks"][name])
            for path, module in network.modules.items():
                module.load_state_dict({key: torch.tensor(tensors[f"{name}.{path}.{key}"]) for key in module.state_dict()})
            return network
        body = moving(50, 33)
        body.tofile(folder / "in")
        subprocess.run([RUN_DENOISER, "answer", folder / "m.safetensors", folder / "in", folder / "out"], check=True)
        found = numpy.fromfile(folder / "out", "<f4").reshape(50, -1, 3)
        error = numpy.abs(found - answered(model, tensors, network_of, body)).max()
        assert error < 1e-4, (method, error)


def standing(foot):
    """Frames [T] in which a smoothed foot [T,3] at 30 Hz is slow, near its lowest places, for four frames or more."""
    steps = numpy.linalg.norm(numpy.diff(foot, axis=0), axis=1)
    slow = 30 * numpy.concatenate([steps[:1], steps]) < .3
    low = foot[:, 1] < numpy.quantile(foot[:, 1], .05) + .1
    out, run = slow & low, 0
    for t in range(len(out) + 1):
        if t < len(out) and out[t]:
            run += 1
        else:
            out[t - run:t] &= run >= 4
            run = 0
    return out


def projected(model, tensors, network, body):
    """The answer after 50 steps of PyTorch's Adam in the code of the network, in the world's space."""
    import torch
    features, base, turn, root, smooth = seen(model, tensors, body)
    layers, names = network.architecture["layers"], model["output"]["joints"]
    middle = [layer["kind"] for layer in layers].index("unpool")
    frames, parents = len(body), model["output"]["parents"]
    base, turn, root = (torch.tensor(x, dtype=torch.float32) for x in (base + tensors["answer.mean"].reshape(-1, 3), turn, root))

    def motion(code):
        x = .5 * code.repeat_interleave(2, dim=1)[:, :frames]
        for i in range(middle + 1, len(layers)):
            x = network._one(layers[i], x, str(i), [])
        return base + model["output"]["scale_m"] * x.reshape(base.shape)
    with torch.no_grad():
        code, pools = torch.tensor(features)[None], []
        for i in range(middle):
            code = network._one(layers[i], code, str(i), pools)
        answer = motion(code)
    code = code.clone().requires_grad_(True)
    bones = [j for j, p in enumerate(parents) if p >= 0]
    above, roots = [parents[j] for j in bones], [j for j, p in enumerate(parents) if p < 0]
    lengths = {j: float(numpy.sort((answer[:, j] - answer[:, parents[j]]).norm(dim=-1).numpy())[frames // 2]) for j in bones}
    mirror = {name: name.replace("Left", "Right") if "Left" in name else name.replace("Right", "Left") for name in names}
    usual = 100 * torch.tensor([(lengths[j] + lengths[names.index(mirror[names[j]])]) / 2 for j in bones])
    feet = [name for name in ("AnkleLeft", "FootLeft", "AnkleRight", "FootRight") if name in names]
    stands = torch.tensor(numpy.stack([standing(smooth[:, model["input"]["joints"].index(name)]) for name in feet], 1))
    stands, places = (stands[1:] & stands[:-1]).float(), [names.index(name) for name in feet]
    adam = torch.optim.Adam([code], lr=.01, eps=1e-5)
    for _ in range(50):
        adam.zero_grad()
        now = motion(code)
        world = 100 * (now @ turn + root)[:, places]
        moves = (world[1:] - world[:-1]).pow(2).sum(-1)
        path = (100 * (now - answer)[:, roots]).pow(2).sum(-1)
        apart = (1e4 * (now[:, bones] - now[:, above]).pow(2).sum(-1) + 1e-4).sqrt() - usual
        (10 * (moves * stands).sum() / stands.sum() + 10 * path.mean() + apart.pow(2).mean()).backward()
        adam.step()
    with torch.no_grad():
        return (motion(code) @ turn + root).numpy(), int(stands.sum())


@case
def a_projected_answer_is_what_PyTorch_s_Adam_finds(folder):
    if not importlib.util.find_spec("torch"):
        raise Skip("needs python3-torch")
    import torch
    import torch_networks
    trained(job(folder, "cnn"))
    model, tensors = read_model(folder / "m.safetensors")
    network = torch_networks.Model(model["networks"]["net"])
    for path, module in network.modules.items():
        module.load_state_dict({key: torch.tensor(tensors[f"net.{path}.{key}"]) for key in module.state_dict()})
    body = moving(51, 33)
    for foot in ("AnkleLeft", "FootLeft"):
        body[:, JOINTS.index(foot)] = body[0, JOINTS.index(foot)]
    torch_networks.write_safetensors(folder / "bodies", {"0.positions": body, "0.seen": numpy.full(body.shape[:2], 2.)}, {})
    words = {"schema": "kinalign.training_job/1", "project": str(folder / "m.safetensors"), "bodies": str(folder / "bodies"),
             "out": str(folder / "answers")}
    (folder / "project.json").write_text(json.dumps(words))
    last = trained(folder / "project.json")
    assert last["after"]["feet_cm"] < .5 * last["before"]["feet_cm"], last
    wanted, stands = projected(model, tensors, network, body)
    assert stands >= 90, stands
    bytes_of = (folder / "answers").read_bytes()
    size = wanted.size * 4
    found = numpy.frombuffer(bytes_of[-size:], "<f4").reshape(wanted.shape)
    error = numpy.abs(found - wanted).max()
    assert error < 1e-3, error


@case
def a_run_that_was_killed_goes_on_to_the_same_bytes(folder):
    options = {"steps": 16, "judge_every": 4}
    trained(job(folder, "refine", options=options))
    whole = (folder / "m.safetensors").read_bytes(), (folder / "run/log.csv").read_bytes()
    (folder / "m.safetensors").unlink()
    path = job(folder, "refine", options=options, keep_every=4, resume=True)
    running = subprocess.Popen([LEARN, path], stdout=subprocess.DEVNULL)
    while not (folder / "run/checkpoint").exists() and running.poll() is None:
        time.sleep(0.002)
    running.send_signal(signal.SIGKILL)
    running.wait()
    in_time(not (folder / "m.safetensors").exists(), "killed before its end")
    assert (folder / "run/checkpoint").exists()
    trained(path)
    assert whole == ((folder / "m.safetensors").read_bytes(), (folder / "run/log.csv").read_bytes())


@case
def a_slow_BLAS_is_told_once_with_the_command_that_helps(folder):
    if not (REFERENCE_BLAS / "libblas.so.3").exists():
        raise Skip("needs the reference BLAS (libblas3)")
    code, lines = learn(job(folder, "refine"), env={"LD_LIBRARY_PATH": str(REFERENCE_BLAS)})
    warnings = [line["warning"] for line in lines if "warning" in line]
    assert code == 0 and len(warnings) == 1, lines
    assert warnings[0].endswith("sudo apt-get install libopenblas0-pthread"), warnings


@case
def what_is_wrong_with_a_job_is_told_as_a_line(folder):
    def refused(path, expected, found):
        code, lines = learn(path)
        assert code == 3, lines
        error = lines[-1]["error"]
        assert (error["expected"], error["found"]) == (expected, found), error
    refused(folder / "none.json", "a job of schema kinalign.training_job/1", "another file")
    refused(job(folder, "magic"), "a known method", "magic")
    refused(job(folder, "refine", input="imu"), 'a stream "imu" with names', "mocap, kinect")
    refused(job(folder, "refine", windows=str(folder / "none.npz")), "a readable file", "No such file or directory")
    refused(job(folder, "refine", learn=["S09-A1"]), "pairs to train on", "none")
    assert not (folder / "m.safetensors").exists()


sys.exit(run_cases("kinalign learn ", sys.argv[3:]))
