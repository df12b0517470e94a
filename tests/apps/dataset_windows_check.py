# SPDX-License-Identifier: Apache-2.0
"""Windows of a data set as NumPy reads them, against the takes as h5py reads them.
dataset_windows_check.py BUILD_FOLDER [CASE...]"""
import json
import pathlib
import sys

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import case, kinalign, main
from data_sets import answer, done, small_set

STREAMS = {"mocap": "clip", "kinect": "points", "imu": "imu"}


def built(folder, **how):
    data = small_set(folder, **how)
    done("build", data)
    return data


def read(path):
    arrays = numpy.load(path)
    return arrays, json.loads(str(arrays["manifest"]))


@case
def every_window_holds_the_rows_of_its_take(folder):
    data = built(folder)
    said = answer("windows", data, "-o", folder / "w.npz", "--length", 50, "--step", 20, "--valid", 0)
    arrays, manifest = read(folder / "w.npz")
    assert manifest["schema"] == "kinalign.windows/1" and len(manifest["takes"]) == 3, manifest
    assert {one["name"]: one["kind"] for one in manifest["streams"]} == STREAMS, manifest["streams"]
    assert said["windows"] == [len(arrays["take"])] and len(arrays["take"]) > 20, said
    covered = [numpy.zeros(one["frames"], bool) for one in manifest["takes"]]
    for i, take in enumerate(arrays["take"]):
        name, first, rows = manifest["takes"][take]["name"], arrays["first"][i], arrays["rows"][i]
        assert rows == 50
        covered[take][first:first + rows] = True
        with h5py.File(data / name[:6] / f"{name}_take.h5") as file:
            assert arrays["time_ns"][i] == file["time_ns"][first]
            for key, facts in manifest["arrays"].items():
                stream, column = facts["stream"], key[len(facts["stream"]) + 1:]
                got = arrays[key][i]
                assert got.shape == (50, len(facts["columns"])), (key, got.shape)
                if column not in file[stream]:
                    assert column == "valid" and stream == "mocap" and got.all()
                    continue
                assert (got == file[stream][column][first:first + rows].reshape(got.shape)).all(), key
            assert (arrays["mocap_rest_offsets"][take] == file["mocap/rest_offsets"]).all()
            assert (arrays["mocap_parents"] == file["mocap/parents"]).all()
    assert all(one.all() for one in covered), "a row lies in no window"
    labels = manifest["arrays"]["mocap_local_rotations"]["columns"]
    assert labels[:5] == ["Hips.w", "Hips.x", "Hips.y", "Hips.z", labels[4]], labels[:5]
    assert manifest["arrays"]["kinect_positions"]["units"] == "m", manifest["arrays"]["kinect_positions"]


@case
def at_another_rate_the_kinect_lies_between_the_takes_rows(folder):
    data = built(folder, takes=1)
    done("windows", data, "-o", folder / "w.npz", "--rate", 25, "--length", 30, "--step", 30, "--valid", 0)
    arrays, manifest = read(folder / "w.npz")
    assert manifest["rate_hz"] == 25
    name = manifest["takes"][0]["name"]
    with h5py.File(data / name[:6] / f"{name}_take.h5") as file:
        times, points = file["time_ns"][:], file["mocap/positions"][:].reshape(len(file["time_ns"]), -1)
    for i, begin in enumerate(arrays["time_ns"]):
        at = begin + numpy.round(numpy.arange(30) * 1e9 / 25).astype(numpy.int64)
        wanted = numpy.stack([numpy.interp((at - times[0]) / 1e9, (times - times[0]) / 1e9, column)
                              for column in points.T], axis=1)
        assert numpy.abs(arrays["mocap_positions"][i] - wanted).max() < 1e-6
    turned = arrays["mocap_local_rotations"].reshape(-1, 4)
    assert numpy.abs(numpy.linalg.norm(turned, axis=1) - 1).max() < 1e-6


@case
def windows_stand_in_the_parts_of_the_split_and_a_split_that_leaks_is_refused(folder):
    data = built(folder, takes=4)
    split = data / "splits.json"
    done("split", data, "--by", "subject", "--test", 0.3, "-o", split)
    done("windows", data, "-o", folder / "w.npz", "--split", split)
    arrays, manifest = read(folder / "w.npz")
    parts = {part["name"]: set(part["takes"]) if isinstance(part["takes"][0], str) else
             {one["name"] for one in part["takes"]} for part in json.loads(split.read_text())["parts"]}
    assert sorted(parts) == ["test", "train"] == sorted(manifest["parts"]), parts
    for take, part in zip(arrays["take"], arrays["part"]):
        assert manifest["takes"][take]["name"] in parts[manifest["parts"][part]]
        assert manifest["takes"][take]["part"] == manifest["parts"][part]
    text = split.read_text()
    both = sorted(parts["train"])[0], sorted(parts["test"])[0]
    split.write_text(text.replace(both[1], both[0]))
    ran = kinalign("dataset", "windows", data, "-o", folder / "leak.npz", "--split", split)
    assert ran.returncode == 3 and not (folder / "leak.npz").exists(), ran


@case
def the_space_of_most_takes_decides_and_every_reason_is_counted(folder):
    data = built(folder, takes=4)
    manifest = sorted(data.glob("sub-*/*_recording.toml"))[0]
    text = manifest.read_text()
    manifest.write_text(text[:text.index("[space.kinect]")])
    done("build", data, code=None)
    said = answer("windows", data, "-o", folder / "w.npz", "--stream", "kinect")
    assert said["takes_left_out"] == [{"take": "sub-00_task-S2A01_run-01", "why": "another space of kinect"}], said
    _, facts = read(folder / "w.npz")
    assert len(facts["takes"]) == 3, facts["takes"]
    ran = kinalign("dataset", "windows", data, "-o", folder / "none.npz", "--stream", "kinect", "--length", 5000)
    assert ran.returncode == 3 and not (folder / "none.npz").exists(), ran
    found = ran.stderr.decode().split("found ")[1]
    assert found == "another space of kinect (1 take); has no window: too short, or too few valid cells (3 takes)\n", found


@case
def what_lacks_a_stream_is_left_out_and_said(folder):
    data = built(folder)
    manifest = sorted(data.glob("sub-*/*_recording.toml"))[0]
    import hfut
    hfut.without(manifest, "imu")
    done("build", data)
    everywhere = answer("windows", data, "-o", folder / "all.npz")
    assert everywhere["takes_left_out"] == [], everywhere
    arrays, facts = read(folder / "all.npz")
    assert [one["name"] for one in facts["streams"]] == ["mocap", "kinect"], facts["streams"]
    said = answer("windows", data, "-o", folder / "imu.npz", "--stream", "imu")
    assert [one["why"] for one in said["takes_left_out"]] == ["has no stream imu"], said
    ran = kinalign("dataset", "windows", data, "-o", folder / "none.npz", "--stream", "marker")
    assert ran.returncode == 3 and b"no stream marker" in ran.stderr, ran.stderr
    ran = kinalign("dataset", "windows", data, "-o", folder / "none.npz", "--valid", 1, "--length", 150)
    assert ran.returncode in (0, 3)
    again = kinalign("dataset", "windows", data, "-o", folder / "all.npz")
    assert again.returncode == 3 and b"--force" in again.stderr, again.stderr


if __name__ == "__main__":
    sys.exit(main())
