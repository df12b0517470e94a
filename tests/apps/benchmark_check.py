# SPDX-License-Identifier: Apache-2.0
"""A twin of the paper's data set: its counts, its bytes, stopped and gone on; methods run on it. benchmark_check.py BUILD_FOLDER [CASE...]"""
import collections
import hashlib
import html
import json
import pathlib
import shlex
import signal
import subprocess
import sys
import time

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
import cases
import hfut
import samples
from bvh_places import bvh_places
from cases import case, done_with, kinalign, main
from data_sets import done
from page_reader import Page

SCALE = "0.0001"  # each cell of the paper's tables is one take of ten seconds


def twin(folder, *words, scale=SCALE, name="twin"):
    """The data set's folder, and what the verb says as JSON."""
    out, _ = done_with(0, "benchmark", "twin", "--scale", scale, "-o", folder / name, "--json", *words)
    return folder / name, json.loads(out)


def digests(data):
    """Of all files but the index, which is a cache."""
    return {str(path.relative_to(data)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(data.rglob("*")) if path.is_file() and ".kinalign" not in path.parts}


def group_of(subject):
    return next(i for i, row in enumerate(hfut.PEOPLE) if subject in row[0])


@case
def each_cell_of_the_papers_tables_has_its_share_of_frames(folder):
    data, _ = twin(folder, "--dry-run", scale="1")
    assert not data.exists(), "a dry run makes nothing"
    data, said = twin(folder)
    plan = json.loads((data / "truth/twin.json").read_text())
    cells = collections.Counter()
    for take in plan["takes"]:
        subject, action, _ = take["name"].split("_")
        cells[group_of(subject[4:]), action[5:7], take["kinect"], take["imu"]] += 1
    assert cells == {cell[:4]: 1 for cell in hfut.cells()}, cells
    assert said["made"] == len(plan["takes"]) == len(list(data.glob("sub-*/*_take.h5"))), said
    assert said["people"] == 12 and said["failed"] == said["were_there"] == 0, said


@case
def a_take_has_the_devices_of_the_plan_and_nearly_its_frames(folder):
    data, _ = twin(folder)
    for take in json.loads((data / "truth/twin.json").read_text())["takes"]:
        subject = take["name"].split("_")[0]
        summary = json.loads((data / subject / f"{take['name']}_take.json").read_text())
        assert abs(summary["frames"] - take["frames"]) <= 3, (take, summary["frames"])
        streams = {one["name"] for one in summary["streams"]}
        assert streams == {"mocap", *["kinect"] * take["kinect"], *["imu"] * take["imu"]}, (take, streams)
        truth = json.loads((data / f"truth/{take['name']}.json").read_text())
        assert truth["schema"] == "kinalign.truth/1" and truth["seed"] == take["seed"], take
        assert len(truth["nodes"]) == 5 * take["imu"], take
    done("verify", data, "--deep")


@case
def the_same_seed_gives_the_same_bytes_with_any_number_of_threads(folder):
    one, _ = twin(folder, "--jobs", "1", name="a/twin")
    two, _ = twin(folder, "--jobs", "2", name="b/twin")
    assert digests(one) == digests(two)
    other, _ = twin(folder, "--seed", "2", name="c/twin")
    same = [name for name, digest in digests(other).items() if digests(one).get(name) == digest]
    assert same == ["dataset.toml"], same


@case
def a_job_that_is_killed_goes_on_and_ends_with_the_same_bytes(folder):
    whole, said = twin(folder, name="a/twin")
    data = folder / "b/twin"
    words = [cases.PROGRAM, "benchmark", "twin", "--scale", SCALE, "-o", data, "--jobs", "2"]
    for least, sign in ((2, signal.SIGKILL), (5, signal.SIGTERM)):
        with subprocess.Popen(list(map(str, words)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              stdin=subprocess.DEVNULL) as program:
            while program.poll() is None and len(list(data.glob("sub-*/*_take.json"))) < least:
                time.sleep(0.01)
            program.send_signal(sign)
            program.communicate(timeout=60)
        assert program.returncode in (-sign, 130), program.returncode
    before = {path: path.stat().st_mtime_ns for path in data.glob("sub-*/*_take.json")}
    assert 5 <= len(before) < said["made"], len(before)
    _, again = twin(folder, name="b/twin")
    assert again["were_there"] == len(before) and again["made"] == said["made"] - len(before), again
    assert all(path.stat().st_mtime_ns == then for path, then in before.items())
    assert digests(data) == digests(whole)
    assert not (data / ".kinalign/twin").exists()


@case
def a_job_that_is_killed_before_its_plan_goes_on(folder):
    (folder / "twin/truth").mkdir(parents=True)
    data, said = twin(folder)
    assert said["made"] > 0 and (data / "truth/twin.json").exists(), said


@case
def another_twin_or_other_files_are_not_touched(folder):
    data, _ = twin(folder)
    before = digests(data)
    for words in (("--scale", SCALE, "--seed", "2"), ("--scale", "0.0002")):
        _, err = done_with(3, "benchmark", "twin", *words, "-o", data)
        assert "expected a twin with the same scale, seed and motions" in err, err
    other = folder / "other"
    other.mkdir()
    (other / "mine.txt").write_text("mine")
    _, err = done_with(3, "benchmark", "twin", "--scale", SCALE, "-o", other)
    assert "expected a new folder, or an unfinished twin" in err, err
    assert digests(data) == before and [path.name for path in other.iterdir()] == ["mine.txt"]


@case
def every_second_take_has_a_motion_of_a_file_on_the_body_of_its_person(folder):
    motions = folder / "motions"
    motions.mkdir()
    for seed, seconds in ((1, 4), (2, 20)):  # shorter than a take, and longer
        done_with(0, "simulate", "built-in", "-o", folder / f"r{seed}", "--seed", seed, "--seconds", seconds)
        (folder / f"r{seed}/truth/motion.bvh").rename(motions / f"{seed}.bvh")
    (motions / "notes.txt").write_text("no motion")
    data, said = twin(folder, "--motion", motions)
    plan = json.loads((data / "truth/twin.json").read_text())
    assert plan["motions"] == ["1.bvh", "2.bvh"], plan["motions"]
    names = [json.loads((data / f"truth/{take['name']}.json").read_text())["motion"] for take in plan["takes"]]
    assert names[1::2] == ["1.bvh", "2.bvh"] * (len(names) // 4) + ["1.bvh"] * (len(names) // 2 % 2), names
    assert all(name.startswith("built-in S") for name in names[::2]), names
    assert said["failed"] == 0 and said["made"] == len(names), said
    done("verify", data, "--deep")
    # All takes have the skeleton of a suit, so that all of them go into windows.
    assert "left out" not in done("windows", data, "-o", folder / "w.npz", "--stream", "mocap")


@case
def a_folder_without_motions_and_a_motion_of_another_skeleton_are_told(folder):
    motions = folder / "motions"
    motions.mkdir()
    _, err = done_with(3, "benchmark", "twin", "--scale", SCALE, "-o", folder / "twin", "--motion", motions)
    assert "expected a folder with BVH files, found no BVH file" in err and not (folder / "twin").exists(), err
    (motions / "other.bvh").write_text(samples.bvh())
    out, _ = done_with(1, "benchmark", "twin", "--scale", SCALE, "-o", folder / "twin", "--motion", motions)
    failed = [line for line in out.splitlines() if line.startswith("failed")]
    assert failed and all("other.bvh: expected " in line for line in failed), out


@case
def methods_are_held_against_each_other_on_a_twin(folder):
    data, said = twin(folder)
    for name in said["splits"]:
        done("split", data, "--check", data / name)
    assert "splits/people.json" in said["splits"], said
    ran = kinalign("eval", "raw", "offset", "--data", data, "-o", folder / "results", "--json", seconds=120)
    assert ran.returncode == 0, ran.stderr
    rows = {row["method"]: row for row in json.loads(ran.stdout)["rows"]}
    assert 3 < rows["offset"]["mpjpe_cm"] < rows["raw"]["mpjpe_cm"] < 15, rows


def run(data, folder, *words, code=0, name="results"):
    """The folder of results, and what the verb says: as JSON, or on stderr."""
    out, err = done_with(code, "benchmark", "run", data, *words, "-o", folder / name, "--json", memory=1 << 36,
                         seconds=600)  # LibTorch alone maps a gigabyte
    return folder / name, json.loads(out) if code == 0 else err


def test_people(data):
    parts = {part["name"]: part["takes"] for part in json.loads((data / "splits/people.json").read_text())["parts"]}
    return {take["name"].split("_")[0][4:] for take in parts["test"]}


def header_of(model):
    """What a SafeTensors file says of itself."""
    with open(model, "rb") as file:
        length = int.from_bytes(file.read(8), "little")
        return json.loads(file.read(length))["__metadata__"]


@case
def methods_run_on_a_twin_make_tables_and_a_page_that_loads_nothing(folder):
    data, _ = twin(folder)
    results, said = run(data, folder, "raw", "offset", "ridge")
    rows = {row["method"]: row for row in said["rows"]}
    assert list(rows) == [name + end for name in ("raw", "offset", "ridge") for end in ("", ", steadied")], list(rows)
    assert 3 < rows["offset"]["position_cm"] < rows["raw"]["position_cm"] < 15, rows
    assert rows["ridge, steadied"]["constancy_cm"] < 0.2 < rows["ridge"]["constancy_cm"], rows
    for file in ("table_9.md", "table_9.tex", "table_9.csv"):
        assert "offset, steadied" in (results / file).read_text(), file
    page = Page((results / "benchmark.html").read_text())
    assert all(link.startswith("#") and link[1:] in page.ids for link in page.links), page.links
    # Its script is its own: the policy names its hash, and nothing has an address.
    assert not {"img", "iframe", "link", "object"} & set(page.tags), set(page.tags)
    assert {"table-9", "table-8", "errors", "motion", "figure-8", "figure-9", "figure-10"} <= set(page.ids), page.ids
    for word in ("standing", "waving", "bending", "turning right", "turning left"):
        assert word in page.sections["table-8"], word
    assert f"{rows['raw']['position_cm']:.2f}" in page.sections["table-9"]
    # The Kinect, three methods and the truth, five instants each; the figures beside.
    assert page.tags.count("svg") >= 25, page.tags.count("svg")
    assert "five nodes" in page.sections["figure-8"] and "one on the head" in page.sections["figure-9"]


# Joints of a suit and of CMU at the same places: the middle of the hips, then those that are marked.
PLACES = {"LeftUpLeg": "lfemur", "RightUpLeg": "rfemur", "LeftArm": "lhumerus", "RightArm": "rhumerus",
          "LeftForeArm": "lradius", "RightForeArm": "rradius", "LeftHand": "lhand", "RightHand": "rhand",
          "LeftLeg": "ltibia", "RightLeg": "rtibia", "LeftFoot": "lfoot", "RightFoot": "rfoot", "Head": "head"}


def about_the_hips(places):
    """Moved to the middle of the hips and turned so that hips and shoulders point to +x."""
    places = places - places[:, :2].mean(axis=1, keepdims=True)
    left = places[:, 0] - places[:, 1] + places[:, 2] - places[:, 3]
    angle = numpy.arctan2(left[:, 2], left[:, 0])[:, None]
    x, y, z = numpy.moveaxis(places, 2, 0)
    return numpy.stack([numpy.cos(angle) * x + numpy.sin(angle) * z, y,
                        numpy.cos(angle) * z - numpy.sin(angle) * x], axis=2)


@case
def the_errors_of_figure_8_are_those_of_the_bvh_that_pose_writes(folder):
    data, _ = twin(folder)
    _, said = run(data, folder, "raw")
    row, = said["figures"]["figure-8"]
    names = [path.name[:-8] for path in sorted(data.glob("sub-*/*_take.h5"))]
    with_nodes = [name for name in names if "imu" in h5py.File(data / name[:6] / f"{name}_take.h5")]
    tested = [name for name in with_nodes if name[4:6] in test_people(data)] or with_nodes
    sums, wrists, frames = 0.0, 0.0, 0
    for name in tested[:12]:
        take = data / name[:6] / f"{name}_take.h5"
        done_with((0, 1), "pose", take, "-o", folder / f"{name}.bvh")
        joints, answer = bvh_places(folder / f"{name}.bvh")
        with h5py.File(take) as file:
            suit = list(file["mocap/joint_names"].asstr())
            truth = file["mocap/positions"][::2]  # 60 Hz, and 30 Hz of the model
        count = min(len(truth), len(answer))
        apart = 100 * numpy.linalg.norm(
            about_the_hips(numpy.stack([answer[:count, joints.index(one)] for one in PLACES.values()], axis=1)) -
            about_the_hips(numpy.stack([truth[:count, suit.index(one)] for one in PLACES], axis=1)), axis=2)
        sums, wrists, frames = sums + apart[:, 2:].mean(axis=1).sum(), wrists + apart[:, 6:8].mean(axis=1).sum(), frames + count
    # The model's grid begins at the waist's first sample here, and at the mocap's there: up to 33 ms apart.
    assert abs(row["all_cm"] - sums / frames) < 0.02 * row["all_cm"], (row, sums / frames)
    assert abs(row["wrists_cm"] - wrists / frames) < 0.03 * row["wrists_cm"], (row, wrists / frames)


@case
def a_network_is_trained_once_on_the_training_people_and_kept(folder):
    if not (cases.BUILD / "apps/kinalign-learn/kinalign-learn").exists():
        raise cases.Skip("kinalign-learn was not built: it needs libtorch-dev")
    data, _ = twin(folder)
    results, _ = run(data, folder, "raw", "cnn", "--steps", "2", "--jobs", "1")
    model = results / "models/cnn.safetensors"
    learnt = set(json.loads(header_of(model)["kinalign"])["training"]["data"][0]["subjects"])
    assert learnt and not learnt & test_people(data), (learnt, test_people(data))
    before, then = digests(results), model.stat().st_mtime_ns
    run(data, folder, "raw", "cnn", "--steps", "2", "--jobs", "1")
    assert digests(results) == before and model.stat().st_mtime_ns == then
    _, err = run(data, folder, "raw", "cnn", "--steps", "3", "--jobs", "1", code=3)
    assert "expected a model trained on these takes with this seed and these steps" in err, err
    run(data, folder, "raw", "cnn", "--steps", "3", "--jobs", "1", "--force")
    assert model.stat().st_mtime_ns != then


@case
def a_dry_run_says_what_would_be_trained_and_writes_nothing(folder):
    data, _ = twin(folder)
    results, said = run(data, folder, "raw", "cnn", "bra", "--steps", "10", "--dry-run")
    assert [(one["method"], one["is_there"], one["steps"]) for one in said["trainings"]] == [
        ("cnn", False, 10), ("bra", False, 10)], said
    assert said["seconds"] > 0 and not results.exists()


@case
def a_dry_run_names_methods_whose_time_is_not_known_and_each_network_once(folder):
    data, _ = twin(folder)
    _, said = run(data, folder, "raw", "smoothnet", "cnn+project", "cnn", "--dry-run")
    assert [(one["method"], one["seconds"] is None) for one in said["trainings"]] == [
        ("smoothnet", True), ("cnn", False)], said
    for words, last in ((("smoothnet",), "smoothnet     to train, 1,200 steps, unknown time"),
                        (("raw",), "nothing to train")):
        out, _ = done_with(0, "benchmark", "run", data, *words, "-o", folder / "results", "--dry-run")
        assert out.splitlines()[-1] == last, out


PROGRAM = """#!/usr/bin/python3
import sys, numpy
asked = numpy.load(sys.argv[1])
joints, wanted = list(asked["joint_names"]), list(asked["output_names"])
words = {"Hips": "SpineBase", "Spine1": "SpineMid", "Spine3": "SpineShoulder", "Head": "Head"}
for side in ("Left", "Right"):
    for suit, kinect in (("Arm", "Shoulder"), ("ForeArm", "Elbow"), ("Hand", "Wrist"), ("UpLeg", "Hip"),
                         ("Leg", "Knee"), ("Foot", "Ankle")):
        words[side + suit] = kinect + side
assert asked["rate_hz"] == 30 and asked["seen"].shape == asked["positions"].shape[:2]
out = numpy.zeros((len(asked["positions"]), len(wanted), 3), "f4")
for place, name in enumerate(wanted):
    if name in words:
        out[:, place] = asked["positions"][:, joints.index(words[name])]
numpy.savez(sys.argv[2], positions=out[:LAST])
"""


def program(folder, last="None"):
    file = folder / f"own_{last}.py"
    file.write_text(PROGRAM.replace("LAST", last))
    file.chmod(0o755)
    return file


@case
def a_program_of_others_is_marked_as_the_methods_are(folder):
    data, _ = twin(folder)
    split = folder / "other people.json"
    split.write_bytes((data / "splits/people.json").read_bytes())
    results, said = run(data, folder, "raw", "--method", f"own={program(folder)}", "--split", split)
    page = html.unescape((results / "benchmark.html").read_text())
    command = shlex.split("kinalign benchmark run " + page.split("kinalign benchmark run ")[-1].split("<")[0])
    assert command[3:] == [str(data), "raw", "--method", f"own={program(folder)}", "--split", str(split), "--seed", "1",
                           "-o", str(results)], command
    rows = {row["method"]: row for row in said["rows"]}
    # It gives the Kinect's joints back under the suit's names, as raw does.
    for key in ("position_cm", "fitted_cm", "bone_cm", "table_9_position_cm2"):
        assert abs(rows["own"][key] - rows["raw"][key]) < 0.02 * rows["raw"][key], (key, rows)
    assert not (results / "programs").exists()
    _, err = run(data, folder, "raw", "--method", f"own={program(folder, '-1')}", code=3)
    assert "of finite float32 or float64, found another shape, type or value" in err, err
    _, err = run(data, folder, "raw", "--method", "own=false", code=3)
    assert "false: expected exit code 0" in err, err
    for words in ("own", "=x", "o/n=x"):
        _, err = run(data, folder, "raw", "--method", words, code=2)
        assert "--method: expected NAME=PROGRAM" in err, err


@case
def a_page_of_another_kind_is_not_overwritten(folder):
    data, _ = twin(folder)
    page = folder / "results/benchmark.html"
    page.parent.mkdir()
    page.write_text("mine")
    _, err = run(data, folder, "raw", code=3)
    assert "or a page of a benchmark (--force overwrites)" in err and page.read_text() == "mine", err
    run(data, folder, "raw", "--force")
    assert page.read_text().startswith("<!doctype html>")


sys.exit(main())
