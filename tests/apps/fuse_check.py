# SPDX-License-Identifier: Apache-2.0
"""A Kinect and nodes together as users meet it: simulated, aligned, fused. fuse_check.py BUILD_FOLDER [CASE...]"""
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import samples
from cases import Skip, case, done_with, main, refused, wrong
from posed import SAME, simulated, told
from rehearsing import recorded_by_its_lab

ROOT = pathlib.Path(__file__).resolve().parents[2]
SMALL = ROOT / "tests/data/fuzz/fuse_model_fuzz/one.safetensors"
SHIPPED = ROOT / "models/fuse.safetensors"


def in_the_room(path, folder, prefix=""):
    """Joints' positions by name [T,3] m, and the middle of both hips."""
    done_with(0, "convert", path, folder / "arrays.npz", "--force", "--quiet")
    data = numpy.load(folder / "arrays.npz")
    names = list(data[prefix + "joint_names"])
    places = {name: data[prefix + "positions"].astype(float)[:, j] for j, name in enumerate(names)}
    hips = ("LeftUpLeg", "RightUpLeg") if "LeftUpLeg" in names else ("lfemur", "rfemur")
    places["hips"] = (places[hips[0]] + places[hips[1]]) / 2
    return places


def errors_about_hips(bvh, take, folder, frames=None):
    """Mean distance of each joint from the suit's about the hips, in the room, cm."""
    ours, truth = in_the_room(bvh, folder), in_the_room(take, folder, "mocap_")
    rows = numpy.arange(len(ours["head"])) * 2  # 30 of 60 Hz; both grids begin with the take
    rows = rows[rows < len(truth["Head"])]
    keep = slice(None) if frames is None else frames
    return {name: 100 * numpy.linalg.norm((ours[name] - ours["hips"])[:len(rows)][keep]
                                          - (truth[suit] - truth["hips"])[rows][keep], axis=-1).mean()
            for name, suit in SAME.items()}


@case
def the_shipped_model_finds_a_simulated_person_in_the_Kinects_room_and_turns_headings(folder):
    if not SHIPPED.exists():
        raise Skip("no models/fuse.safetensors")
    take, _ = simulated(folder / "sim", seconds=60)
    said = told("fuse", take, "-o", folder / "fused.bvh")
    assert said["kinect"] == "kinect" and said["imu"] == "imu" and said["method"] == "gated", said
    apart = errors_about_hips(folder / "fused.bvh", take, folder)
    assert sum(apart.values()) / len(apart) < 12, apart
    ours, truth = in_the_room(folder / "fused.bvh", folder), in_the_room(take, folder, "mocap_")
    rows = numpy.arange(len(ours["hips"])) * 2
    off = 100 * numpy.linalg.norm(ours["hips"] - truth["hips"][rows], axis=-1).mean()
    assert off < 12, off
    assert set(said["found_headings"]) == set(said["nodes"]), said
    assert all(one["spread_deg"] < 10 for one in said["found_headings"].values()), said["found_headings"]


@case
def an_arm_that_the_Kinect_loses_goes_on_with_its_node(folder):
    if not SHIPPED.exists():
        raise Skip("no models/fuse.safetensors")
    _, manifest = simulated(folder / "sim", seconds=30)
    kinect = folder / "sim/kinect.csv"
    lines = kinect.read_text().splitlines()
    head = lines[0].split(",")
    lost = [k for k, name in enumerate(head) if name.startswith(("ElbowLeft", "WristLeft", "HandLeft"))]
    begin, end = len(lines) // 2, len(lines) // 2 + 150
    for i in range(begin, end):
        cells = lines[i].split(",")
        for k in lost:
            cells[k] = "0"
        lines[i] = ",".join(cells)
    kinect.write_text("\n".join(lines) + "\n")
    take = folder / "torn.h5"
    done_with((0, 1), "align", manifest, "-o", take, "--quiet")
    told("fuse", take, "-o", folder / "torn.bvh", code=(0, 1))
    # The Kinect begins within a second of the take: a second at both ends is left out.
    torn = errors_about_hips(folder / "torn.bvh", take, folder, slice(begin + 30, end - 30))
    assert torn["lradius"] < 15 and torn["lhand"] < 25, torn


@case
def a_take_a_manifest_and_a_recording_are_fused(folder):
    take, manifest = simulated(folder / "sim", seconds=12)
    for name, path in (("a", take), ("b", manifest)):
        said = told("fuse", path, "--model", SMALL, "-o", folder / f"{name}.bvh", code=(0, 1))
        assert said["schema"] == "kinalign.fuse/1" and said["method"] == "small", said
        assert (said["rate_hz"], said["joints"]) == (30, 9), said
        assert said["missing"] < 0.2 and said["t_pose"]["found"], said
        assert told("info", folder / f"{name}.bvh")["streams"][0]["samples"] == said["frames"], said
    text, _ = done_with((0, 1), "fuse", take, "--model", SMALL, "-o", folder / "c.bvh")
    assert "c.bvh: 330 frames at 30 Hz, 9 joints\nkinect " in text and "\nturned   by the Kinect, deg: " in text, text
    assert (folder / "a.bvh").read_bytes() == (folder / "c.bvh").read_bytes()
    recording = recorded_by_its_lab(folder)
    told("fuse", recording, "--model", SMALL, "-o", folder / "live.bvh", code=(0, 1))


@case
def a_file_without_one_of_the_devices_is_refused_by_what_it_lacks(folder):
    walk = folder / "walk.bvh"
    walk.write_text(samples.bvh())
    first = refused("fuse", walk, "--model", SMALL, "-o", folder / "o.bvh", naming=walk)
    assert "nodes" in first, first
    _, manifest = simulated(folder / "sim", seconds=6)
    first = refused("fuse", folder / "sim/kinect.csv", "--model", SMALL, "-o", folder / "o.bvh", naming=folder / "sim/kinect.csv")
    assert first.endswith("expected one stream of inertial nodes (--nodes NAME), found none"), first
    other = ROOT / "tests/data/fuzz/pose_model_fuzz/two.safetensors"
    first = refused("fuse", manifest, "--model", other, "-o", folder / "o.bvh", naming=other)
    assert first.endswith("expected a model for a Kinect and nodes together, found task pose"), first
    (folder / "o.bvh").write_text("mine")
    refused("fuse", manifest, "--model", SMALL, "-o", folder / "o.bvh", naming=folder / "o.bvh")
    assert (folder / "o.bvh").read_text() == "mine"


@case
def a_Kinect_that_never_sees_the_person_while_nodes_send_is_told(folder):
    _, manifest = simulated(folder / "sim", seconds=12)
    kinect = folder / "sim/kinect.csv"
    lines = kinect.read_text().splitlines()
    kinect.write_text("\n".join(lines[:1] + lines[1:12]) + "\n")
    first = refused("fuse", manifest, "--model", SMALL, "-o", folder / "o.bvh", naming=manifest)
    assert first.endswith("expected a second in which the Kinect sees the person and the waist's node sends, found no such second (denoise and pose use one device alone)"), first


@case
def wrong_words_of_fuse_are_told(_):
    wrong("fuse", "take.h5", says="-o: expected -o FILE.bvh, found none")
    wrong("fuse", "take.h5", "-o", "fused.bvh", "--tpose=3",
          says="--tpose: expected START,END in seconds, such as 1.5,4, found 3")
    wrong("train", "gated", "--windows", "w.npz", "-o", "m.safetensors", "--rate", "15",
          says="--rate: expected a method that cleans a stream, found gated, which works at 30 Hz")


sys.exit(main())
