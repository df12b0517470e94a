# SPDX-License-Identifier: Apache-2.0
"""Models as users meet them: trained, shown, used, exported. model_check.py BUILD_FOLDER [CASE...]"""
import fcntl
import importlib.util
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import data_sets
import samples
from cases import BUILD, Skip, case, demo, done_with, kinalign, law, main, refused, wrong

ROOT = pathlib.Path(__file__).resolve().parents[2]
SMALL = ROOT / "tests/data/fuzz/denoise_model_fuzz"  # two models of three joints
NODE_MODULES = pathlib.Path(os.environ.get("KINALIGN_NODE_MODULES", ROOT / "build/npm/node_modules"))
sys.path.insert(0, str(ROOT / "tests/infer"))


def needs_learn():
    if not (BUILD / "apps/kinalign-learn/kinalign-learn").exists():
        raise Skip("kinalign-learn was not built: it needs libtorch-dev")


def trained(data, out, *words, method="refine"):
    """A model after a few steps; what train said. LibTorch alone maps a gigabyte."""
    words = ("train", method, "--data", data, "-o", out, "--steps", "3", "--jobs", "1", "--json", *words)
    ran = kinalign(*words, memory=1 << 36, seconds=300)
    law_but_warnings(ran, words)
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


def law_but_warnings(ran, words):
    """A machine without a fast BLAS is told so."""
    lines = [line for line in ran.stderr.splitlines(True) if not line.startswith(b"kinalign train: warning: ")]
    ran.stderr = b"".join(lines)
    return law(ran, words)


def told(*words, code=0):
    return json.loads(done_with(code, *words, "--json")[0])


def tensors_of(path):
    data = path.read_bytes()
    end = 8 + struct.unpack("<Q", data[:8])[0]
    header = json.loads(data[8:end])
    model = json.loads(header.pop("__metadata__")["kinalign"])
    return model, {name: numpy.frombuffer(data[end:][slice(*one["data_offsets"])], "<f4").reshape(one["shape"])
                   for name, one in header.items()}


def of_kinect(source, out, change):
    """The demo's Kinect file with each row [stamp, x, y, z, state, x, ...] changed; None: left out."""
    head, *rows = source.read_text().splitlines()
    kept = [change(i, row.split(",")) for i, row in enumerate(rows)]
    out.write_text("\n".join([head, *(",".join(row) for row in kept if row)]) + "\n")
    return out


@case
def a_kinect_that_is_upside_down_jumps_or_sends_nonsense_is_told(folder):
    kinect = demo(folder / "demo", seconds=6) / "kinect.csv"
    shipped = ROOT / "models/denoise.safetensors"
    assert kinect.read_text().split("\n")[0].split(",")[1:5:3] == ["SpineBase_x", "SpineBase_state"]

    def moved(place, change):
        return lambda i, row: [repr(change(i, float(one))) if n % 4 == place and one else one for n, one in enumerate(row)]

    down = of_kinect(kinect, folder / "down.csv", moved(2, lambda i, y: -y))
    first = refused("denoise", down, "--model", shipped, "-o", folder / "o.bvh", naming=down)
    assert "expected y up: a head above the hips, found a head below the hips in" in first, first
    mirrored = of_kinect(kinect, folder / "mirrored.csv", moved(1, lambda i, x: -x))
    said = told("denoise", mirrored, "--model", shipped, "-o", folder / "mirrored.bvh", code=1)
    assert any("if the file is mirrored, use a layout with" in one for one in said["warnings"]), said["warnings"]
    jump = of_kinect(kinect, folder / "jump.csv", moved(1, lambda i, x: x + 1.8 * (i > 60)))
    said = told("denoise", jump, "--model", shipped, "-o", folder / "jump.bvh", code=1)
    assert len(said["warnings"]) == 1 and said["warnings"][0].startswith("the body jumps at 2.0 s"), said["warnings"]
    far = of_kinect(kinect, folder / "far.csv", lambda i, row: row[:15] + ["4500"] + row[16:] if i == 60 else row)
    said = told("denoise", far, "--model", shipped, "-o", folder / "far.bvh", code=1)
    by_reader, by_grid = said["warnings"]
    assert "far.csv: expected the points of a frame within 20 m" in by_reader, by_reader
    assert "1.6 m from the root and count as missing" in by_grid, by_grid
    hole = of_kinect(kinect, folder / "hole.csv", lambda i, row: None if 60 < i < 140 else row)
    said = told("denoise", hole, "--model", shipped, "-o", folder / "hole.bvh", code=1)
    assert len(said["warnings"]) == 1 and said["warnings"][0].startswith("19 joints are missing for "), said["warnings"]


@case
def every_shipped_model_says_by_what_on_what_and_on_what_terms_it_was_made(folder):
    for path in sorted((ROOT / "models").glob("*.safetensors")):
        said = told("info", path)
        data = said["training"]["data"][0]
        assert said["software"].startswith("kinalign "), path
        assert data["licence"] and data["citation"] and len(data["windows_sha256"]) == 64, (path, data)


@case
def two_trainings_of_one_name_do_not_mix(folder):
    needs_learn()
    out = folder / "m.safetensors"
    (folder / "m.training").mkdir()
    with open(folder / "m.training/lock", "w", encoding="ascii") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        first = refused("train", "refine", "--windows", folder / "none.npz", "-o", out, naming=folder / "m.training")
        assert first.endswith("expected a folder that no other training uses now, found another training in this folder"), first


@case
def other_corpora_are_pairs_too(folder):
    needs_learn()
    shared = ROOT.parent / "shared/data"
    for name, streams, joints in (("kinect_multitrack", ("--input", "kinect0", "--truth", "kinect1"), 25), ("kinect_keraal", (), 17)):
        if not (shared / name).exists():
            raise Skip("no shared/data")
        data = folder / name
        done_with(0, "dataset", "import", data, shared / name)
        done_with(0, "dataset", "build", data)
        model = folder / f"{name}.safetensors"
        trained(data, model, *streams)
        assert len(told("info", model)["output"]["joints"]) == joints


@case
def a_network_is_trained_shown_used_and_exported(folder):
    needs_learn()
    data = data_sets.small_set(folder)
    data_sets.done("build", data)
    model = folder / "m.safetensors"
    said = trained(data, model)
    assert said["schema"] == "kinalign.train/1" and said["written"] == str(model) and said["loss"] > 0, said
    assert (folder / "m.training/log.csv").read_text().startswith("step,loss"), "no log"
    assert not (folder / "m.training/windows.npz").exists() and not (folder / "m.training/checkpoint.safetensors").exists()
    shown = told("info", model)
    assert (shown["kind"], shown["task"], shown["method"], shown["rate_hz"]) == ("model", "denoise", "refine", 30), shown
    assert len(shown["input"]["joints"]) == 25 and "SpineBase" in shown["input"]["joints"], shown["input"]
    assert shown["networks"]["net"]["look_back"] == 17 and shown["networks"]["net"]["look_ahead"] == 17, shown["networks"]
    used, = shown["training"]["data"]
    assert used["stretches"] >= 3 and used["frames"] > 200 and used["subjects"] == ["00", "01", "02"], used
    assert (shown["training"]["steps"], shown["training"]["seed"]) == (3, 1), shown["training"]
    take = next(iter(sorted(data.rglob("*.h5"))))
    for out in ("clean.bvh", "clean.trc"):
        cleaned = told("denoise", take, "--stream", "kinect", "--model", model, "-o", folder / out)
        assert cleaned["stream"] == "kinect" and cleaned["rate_hz"] == 30 and cleaned["radius_90_cm"] > 0, cleaned
        seen = told("info", folder / out)["streams"][0]
        assert seen["samples"] == cleaned["frames"], seen
    onnx = told("model", "export", model, "-o", folder / "m.onnx")
    assert onnx["inputs"] == 7 * 25 and onnx["outputs"] == 4 * cleaned["joints"], onnx


@case
def standing_feet_of_a_projected_answer_move_less(folder):
    needs_learn()
    data = data_sets.small_set(folder, takes=1)
    data_sets.done("build", data)
    model = folder / "cnn.safetensors"
    trained(data, model, method="cnn")
    take = next(iter(sorted(data.rglob("*.h5"))))

    def words(model):
        return ("denoise", take, "--stream", "kinect", "--model", model, "--project", "-o", folder / "clean.bvh")
    ran = kinalign(*words(model), "--json", memory=1 << 36, seconds=300)
    law(ran, words(model))
    assert ran.returncode == 0, ran.stderr
    said = json.loads(ran.stdout)
    before, after = said["projected"]["feet_cm"]
    assert after < before / 2, said
    assert told("info", folder / "clean.bvh")["streams"][0]["samples"] == said["frames"], said
    (folder / "clean.bvh").unlink()
    other = ROOT / "models/denoise.safetensors"
    ran = kinalign(*words(other), memory=1 << 36)
    assert ran.returncode == 3 and b"expected a model whose network has a hidden space, such as a cnn model" in ran.stderr, ran
    alone = folder / "alone/kinalign"
    alone.parent.mkdir()
    shutil.copy(BUILD / "apps/kinalign/kinalign", alone)
    ran = subprocess.run([alone, *words(model)], capture_output=True, check=False)
    assert ran.returncode == 3 and b"kinalign-learn" in ran.stderr and b"no kinalign-learn in the folder of kinalign" in ran.stderr, ran
    assert not (folder / "clean.bvh").exists()


@case
def a_smoother_along_time_is_trained_used_and_exported(folder):
    needs_learn()
    data = data_sets.small_set(folder, takes=1)
    data_sets.done("build", data)
    model = folder / "s.safetensors"
    trained(data, model, "--hand-weight", "3", method="smoothnet")
    shown = told("info", model)
    assert shown["method"] == "smoothnet" and shown["networks"]["net"]["look_ahead"] == 31, shown
    assert shown["training"]["hand_weight"] == 3, shown["training"]
    take = next(iter(sorted(data.rglob("*.h5"))))
    cleaned = told("denoise", take, "--stream", "kinect", "--model", model, "-o", folder / "s.bvh")
    onnx = told("model", "export", model, "-o", folder / "s.onnx")
    assert onnx["inputs"] == 7 * 25 and onnx["outputs"] == 3 * cleaned["joints"], onnx


@case
def the_same_seed_trains_the_same_model_and_another_one_another(folder):
    needs_learn()
    data = data_sets.small_set(folder, takes=1)
    data_sets.done("build", data)
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        trained(data, folder / f"{name}.safetensors", "--seed", seed)
    a, b, c = ((folder / f"{name}.safetensors").read_bytes() for name in "abc")
    assert a == b != c


@case
def a_prepared_job_is_done_by_kinalign_learn_alone_with_the_same_result(folder):
    needs_learn()
    data = data_sets.small_set(folder, takes=1)
    data_sets.done("build", data)
    trained(data, folder / "here.safetensors")
    out = folder / "there.safetensors"
    said = trained(data, out, "--prepare")
    assert not out.exists() and said["jobs"] == [str(folder / "there.training/job.json")], said
    subprocess.run([BUILD / "apps/kinalign-learn/kinalign-learn", *said["jobs"]], check=True, capture_output=True)
    assert out.read_bytes() == (folder / "here.safetensors").read_bytes()


@case
def train_takes_one_source_and_never_replaces_a_file_unasked(folder):
    wrong("train", "refine", "-o", folder / "m.safetensors",
          says="--data: expected a data set (--data) or a file of windows (--windows), found neither")
    wrong("train", "refine", "--data", "d", "--windows", "w", "-o", folder / "m.safetensors",
          says="--data: expected a data set (--data) or a file of windows (--windows), found both")
    wrong("train", "refine", "--data", "d", "-o", "m.onnx", says="-o: expected -o FILE.safetensors, found m.onnx")
    wrong("train", "refine", "--data", "d", "-o", "m.safetensors", "--vary-size", "0.1",
          says="--vary-size: expected a method for poses or for fusion, found refine")
    (folder / "m.safetensors").write_text("mine")
    refused("train", "refine", "--data", folder, "-o", folder / "m.safetensors", naming=folder / "m.safetensors")
    assert (folder / "m.safetensors").read_text() == "mine"


@case
def info_shows_a_model_as_lines(_):
    text, _ = done_with(0, "info", SMALL / "two.safetensors")
    for line in ("model       denoise, method refine", "rate        30 Hz", "input       3 joints: SpineBase, HipLeft, HipRight",
                 "network     net: 21 in, 12 out", "conv 4, kernel 3, dilation 2", "network     second: 9 in, 9 out",
                 "lstm 3, both directions"):
        assert line in text, f"{line} is not in {text}"


@case
def a_model_is_no_motion(folder):
    model = SMALL / "one.safetensors"
    for words in (("check", model), ("convert", model, folder / "o.npz"),
                  ("denoise", model, "--model", model, "-o", folder / "o.bvh")):
        first = refused(*words, naming=model)
        assert first.endswith("found a model (SafeTensors): kinalign info shows what is in it"), first


@case
def a_file_that_is_no_model_of_ours_is_refused(folder):
    walk = folder / "walk.bvh"
    walk.write_text(samples.bvh())
    for words in (("model", "export", walk, "-o", folder / "m.onnx"), ("denoise", walk, "--model", walk, "-o", folder / "o.bvh")):
        done = kinalign(*words)
        said = law(done, words, words[-1])
        assert done.returncode == 3 and str(walk) in said, said
    whole = (SMALL / "one.safetensors").read_bytes()
    (folder / "cut.safetensors").write_bytes(whole[:-4])
    refused("info", folder / "cut.safetensors", naming=folder / "cut.safetensors")


def exported(folder, name, network="net"):
    told("model", "export", SMALL / f"{name}.safetensors", "--network", network, "-o", folder / f"{network}.onnx")
    return folder / f"{network}.onnx"


@case
def the_ONNX_checker_accepts_what_is_exported(folder):
    if not importlib.util.find_spec("onnx"):
        raise Skip("needs python3-onnx")
    import onnx
    for network, channels in (("net", (21, 12)), ("second", (9, 9))):
        model = onnx.load(str(exported(folder, "two", network)))
        onnx.checker.check_model(model, full_check=True)
        sizes = [[one.type.tensor_type.shape.dim[2].dim_value for one in ends] for ends in
                 (model.graph.input, model.graph.output)]
        assert sizes == [[channels[0]], [channels[1]]], sizes
        metadata = {one.key: one.value for one in model.metadata_props}
        assert metadata["kinalign.task"] == "denoise" and metadata["kinalign.rate_hz"] == "30", metadata
        assert json.loads(metadata["kinalign.output_joints"]) == ["SpineBase", "HipLeft", "HipRight"], metadata
    first = refused_export(folder, SMALL / "one.safetensors", "--network", "second")
    assert first.endswith("expected a second network, found none"), first


def refused_export(folder, *words):
    done = kinalign("model", "export", *words, "-o", folder / "none.onnx")
    law(done, ("model", "export", *words), folder / "none.onnx")
    assert done.returncode == 3, done.stderr
    return done.stderr.decode().splitlines()[0]


@case
def ONNX_Runtime_computes_with_the_scales_in_the_graph(folder):
    if not shutil.which("node") or not (NODE_MODULES / "onnxruntime-node").is_dir():
        raise Skip("needs node and npm's onnxruntime-node")
    if not importlib.util.find_spec("torch"):
        raise Skip("needs python3-torch")
    import torch
    import torch_networks
    model, tensors = tensors_of(SMALL / "one.safetensors")
    network = torch_networks.Model(model["networks"]["net"])
    for path, module in network.modules.items():
        module.load_state_dict({key: torch.tensor(tensors[f"net.{path}.{key}"]) for key in module.state_dict()})
    given = numpy.random.default_rng(1).standard_normal((31, 21)).astype("<f4")
    out = network(((given - tensors["input.mean"]) / tensors["input.scale"]).astype("<f4"))
    out[:, :9] = tensors["answer.mean"] + model["output"]["scale_m"] * out[:, :9]
    exported(folder, "one").rename(folder / "0.onnx")
    given.tofile(folder / "0.in")
    subprocess.run(["node", ROOT / "tests/witness/onnx_runtime.mjs", NODE_MODULES, folder, "0:31"], check=True,
                   capture_output=True)
    found = numpy.fromfile(folder / "0.out", "<f4").reshape(31, 12)
    assert numpy.abs(found - out).max() < 1e-5


@case
def ONNX_Runtime_answers_with_rotations_and_a_way_for_poses_and_fusion(folder):
    if not shutil.which("node") or not (NODE_MODULES / "onnxruntime-node").is_dir():
        raise Skip("needs node and npm's onnxruntime-node")
    if not importlib.util.find_spec("torch"):
        raise Skip("needs python3-torch")
    import torch
    import torch_networks
    for task, path in (("pose", "pose_model_fuzz/two"), ("fuse", "fuse_model_fuzz/one")):
        path = SMALL.parent / f"{path}.safetensors"
        model, tensors = tensors_of(path)
        network = torch_networks.Model(model["networks"]["net"])
        for place, module in network.modules.items():
            module.load_state_dict({key: torch.tensor(tensors[f"net.{place}.{key}"]) for key in module.state_dict()})
        channels = len(tensors["input.mean"])
        given = numpy.random.default_rng(1).standard_normal((31, channels)).astype("<f4")
        out = network(((given - tensors["input.mean"]) / tensors["input.scale"]).astype("<f4"))
        bones = len(model["output"]["bones"]) + (task == "fuse")
        out[:, :6 * bones] += numpy.tile([1, 0, 0, 0, 1, 0], bones)
        out[:, 6 * bones:] *= 0.1
        told("model", "export", path, "-o", folder / "0.onnx", "--force")
        given.tofile(folder / "0.in")
        subprocess.run(["node", ROOT / "tests/witness/onnx_runtime.mjs", NODE_MODULES, folder, "0:31"], check=True,
                       capture_output=True)
        found = numpy.fromfile(folder / "0.out", "<f4").reshape(31, -1)
        assert found.shape == out.shape and numpy.abs(found - out).max() < 1e-5, task


sys.exit(main())
