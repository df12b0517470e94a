# SPDX-License-Identifier: Apache-2.0
"""A twin of the paper's data set: its counts, its bytes, stopped and gone on. benchmark_check.py BUILD_FOLDER [CASE...]"""
import collections
import hashlib
import json
import pathlib
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
import cases
import hfut
import samples
from cases import case, done_with, kinalign, main
from data_sets import done

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
def another_twin_or_other_files_are_not_touched(folder):
    data, _ = twin(folder)
    before = digests(data)
    for words in (("--scale", SCALE, "--seed", "2"), ("--scale", "0.0002")):
        _, err = done_with(3, "benchmark", "twin", *words, "-o", data)
        assert "expected a twin of the same scale, seed and motions" in err, err
    other = folder / "other"
    other.mkdir()
    (other / "mine.txt").write_text("mine")
    _, err = done_with(3, "benchmark", "twin", "--scale", SCALE, "-o", other)
    assert "expected a new folder, or a twin that was begun" in err, err
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
    assert "expected a folder with BVH files, found none in it" in err and not (folder / "twin").exists(), err
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


sys.exit(main())
