# SPDX-License-Identifier: Apache-2.0
"""The pose from nodes as users meet it: simulated, aligned, answered. pose_check.py BUILD_FOLDER [CASE...]"""
import json
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import data_sets
import samples
from cases import BUILD, Skip, case, done_with, kinalign, law, main, refused, wrong
from posed import SAME, cmu_people, simulated, told
from rehearsing import recorded_by_its_lab

ROOT = pathlib.Path(__file__).resolve().parents[2]
SMALL = ROOT / "tests/data/fuzz/pose_model_fuzz"  # one: three nodes; two: the five usual ones
SHIPPED = ROOT / "models/pose.safetensors"

def arrays(path, folder, prefix=""):
    """Joints' positions about the middle of both hips, in the root's space: by name [T,3] m."""
    done_with(0, "convert", path, folder / "arrays.npz", "--force", "--quiet")
    data = numpy.load(folder / "arrays.npz")
    names = list(data[prefix + "joint_names"])
    places = data[prefix + "positions"].astype(float)
    w, x, y, z = data[prefix + "local_rotations"][:, 0].astype(float).T
    to_world = numpy.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                            2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                            2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], -1).reshape(-1, 3, 3)
    hips = [names.index(name) for name in (("LeftUpLeg", "RightUpLeg") if "LeftUpLeg" in names else ("lfemur", "rfemur"))]
    about = places - places[:, hips].mean(1, keepdims=True)
    return {name: numpy.einsum("tij,ti->tj", to_world, about[:, j]) for j, name in enumerate(names)}


def errors(pose, take, folder):
    """Mean distance of each joint from the suit's, cm. The grid of the pose begins with the take."""
    ours, truth = arrays(pose, folder), arrays(take, folder, "mocap_")
    frames = len(ours["head"])
    rows = numpy.arange(frames) * 2  # 30 of 60 Hz
    return {name: 100 * numpy.linalg.norm(ours[name] - truth[suit][rows], axis=-1).mean() for name, suit in SAME.items()}


@case
def the_shipped_model_answers_a_simulated_persons_nodes_within_20_cm_of_the_suit(folder):
    if not SHIPPED.exists():
        raise Skip("no models/pose.safetensors")
    for seed in (1, 2):
        take, _ = simulated(folder / f"{seed}", seed=seed)
        said = told("pose", take, "-o", folder / f"{seed}.bvh")
        assert said["headings"] == "mounting" and said["t_pose"]["found"], said
        apart = errors(folder / f"{seed}.bvh", take, folder)
        mean = sum(apart.values()) / len(apart)
        assert mean < 14, apart
        assert max(apart.values()) < 25, apart
        said = told("pose", take, "-o", folder / "wrong.bvh", "--heading", "shared", "--force", code=1)
        assert len(said["warnings"]) == 1 and said["warnings"][0].endswith("--heading mounting"), said["warnings"]
        wrong_mean = sum(errors(folder / "wrong.bvh", take, folder).values()) / len(apart)
        assert wrong_mean > mean + 4, (wrong_mean, mean)


@case
def a_take_and_the_files_it_was_made_of_give_a_pose(folder):
    take, manifest = simulated(folder / "sim", seconds=12)
    for name, path in (("a", take), ("b", manifest)):
        said = told("pose", path, "--model", SMALL / "two.safetensors", "-o", folder / f"{name}.bvh")
        assert said["schema"] == "kinalign.pose/1" and said["stream"] == "imu" and said["method"] == "small", said
        assert (said["rate_hz"], said["joints"], said["warnings"]) == (30, 9, []), said
        assert said["valid"] > 0.99 and said["t_pose"]["found"] and said["t_pose"]["to_s"] > 2, said
        assert set(said["nodes"]) == {"wrist_left", "wrist_right", "ankle_left", "ankle_right", "waist"}, said
        assert all(node["tilt_deg"] < 20 for node in said["nodes"].values()), said
        seen = told("info", folder / f"{name}.bvh")["streams"][0]
        assert seen["samples"] == said["frames"], seen
    text, _ = done_with(0, "pose", take, "--model", SMALL / "two.safetensors", "-o", folder / "c.bvh")
    assert "c.bvh: 330 frames at 30 Hz, 9 joints\nbody     of stature 1.84 m, from the model\nnodes    5 of 5, 100.0 % valid\nT-pose   0.0 to " in text, text
    assert (folder / "a.bvh").read_bytes() == (folder / "c.bvh").read_bytes()


def leg_length(path, folder):
    """Thigh and shank of a BVH at its first frame, m."""
    done_with(0, "convert", path, folder / "legs.npz", "--force", "--quiet")
    data = numpy.load(folder / "legs.npz")
    names, places = list(data["joint_names"]), data["positions"][0].astype(float)
    hip, knee, ankle = (places[names.index(one)] for one in
                        (("LeftUpLeg", "LeftLeg", "LeftFoot") if "LeftUpLeg" in names else ("lfemur", "ltibia", "lfoot")))
    return numpy.linalg.norm(knee - hip) + numpy.linalg.norm(ankle - knee)


@case
def the_answer_has_the_bones_of_a_stature_or_of_a_suit(folder):
    if not SHIPPED.exists():
        raise Skip("no models/pose.safetensors")
    take, manifest = simulated(folder / "sim", seconds=12)
    suit = manifest.parent / "mocap.bvh"
    for body, legs in (("1.60", 0.48 * 1.60), (suit, leg_length(suit, folder))):
        out = folder / f"{legs:.3f}.bvh"
        said = told("pose", take, "--model", SHIPPED, "-o", out, "--body", body)
        assert said["body"]["by"] == "--body" and abs(said["body"]["stature_m"] - legs / 0.48) < 1e-3, said["body"]
        assert abs(leg_length(out, folder) - legs) < 1e-3, (body, leg_length(out, folder), legs)
    for wrong in ("3.1", "tall"):
        _, complaint = done_with(2, "pose", take, "-o", folder / "x.bvh", "--body", wrong)
        assert "expected a stature from 0.5 to 2.6 m, or a BVH of the suit" in complaint, complaint


@case
def a_recording_of_a_labs_devices_gives_a_pose_and_a_clean_Kinect(folder):
    recording = recorded_by_its_lab(folder)
    said = told("pose", recording, "--model", SMALL / "two.safetensors", "-o", folder / "pose.bvh")
    assert said["valid"] > 0.98 and said["t_pose"]["found"] and said["headings"] == "mounting", said
    told("denoise", recording, "-o", folder / "clean.bvh")


@case
def nodes_that_say_no_orientation_get_one_of_their_rates_and_forces(folder):
    _, manifest = simulated(folder / "sim", seconds=12)
    said = told("pose", manifest, "--model", SMALL / "two.safetensors", "-o", folder / "a.bvh")
    for path in folder.glob("sim/imu_*.csv"):
        rows = [line.split(",") for line in path.read_text().splitlines()]
        path.write_text("\n".join(",".join([row[0], *row[5:]]) for row in rows) + "\n")
    bare = told("pose", manifest, "--model", SMALL / "two.safetensors", "-o", folder / "b.bvh")
    assert bare["warnings"] == [] and bare["headings"] == "mounting", bare
    for node, one in bare["nodes"].items():
        assert abs(one["tilt_deg"] - said["nodes"][node]["tilt_deg"]) < 3, (node, one)


@case
def arms_that_hang_and_a_T_pose_that_is_not_held_still_are_told(folder):
    take, _ = simulated(folder / "sim", seconds=12)
    said = told("pose", take, "--model", SMALL / "two.safetensors", "-o", folder / "a.bvh", "--tpose", "6,7", code=1)
    assert len(said["warnings"]) == 3, said["warnings"]
    assert "did not hold still" in said["warnings"][0], said["warnings"]
    assert said["warnings"][1].startswith("wrist_left is ") and "arms hung" in said["warnings"][1], said["warnings"]
    assert said["t_pose"]["from_s"] == 6 and not said["t_pose"]["found"], said


def node_rows(path):
    return [line.split(",") for line in path.read_text().splitlines()]


def put_rows(path, rows):
    path.write_text("\n".join(",".join(row) for row in rows) + "\n")


@case
def nodes_in_each_others_place_in_another_unit_or_frozen_are_told(folder):
    words = ("--model", SMALL / "two.safetensors", "--force")
    _, manifest = simulated(folder / "sim", seconds=12)
    sim, out = manifest.parent, folder / "a.bvh"
    assert told("pose", manifest, "-o", out, *words)["warnings"] == []
    waist, wrist = sim / "imu_waist.csv", sim / "imu_wrist_left.csv"
    was = waist.read_text(), wrist.read_text()
    waist.write_text(was[1])
    wrist.write_text(was[0])
    said = told("pose", manifest, "-o", out, *words, code=1)["warnings"]
    assert any("were these nodes swapped?" in one and "waist" in one for one in said), said
    waist.write_text(was[0])
    wrist.write_text(was[1])
    rows = node_rows(wrist)
    put_rows(wrist, rows[:600] + [[row[0], *rows[600][1:]] for row in rows[600:800]] + rows[800:])
    said = told("pose", manifest, "-o", out, *words, code=1)["warnings"]
    assert len(said) == 1 and said[0].startswith("wrist_left repeats one sample for "), said
    put_rows(wrist, [rows[0]] + [row[:5] + [repr(float(a) / 9.80665) for a in row[5:8]] + row[8:] for row in rows[1:]])
    said = told("pose", manifest, "-o", out, *words, code=1)["warnings"]
    by_reader, by_t_pose = said
    assert "imu_wrist_left.csv: expected accelerations with gravity of 6 to 40 m/s2" in by_reader, said
    assert by_t_pose.startswith("wrist_left: 8.8 m/s2 in the T-pose are not gravity"), said
    wrist.write_text(was[1])
    put_rows(waist, node_rows(waist)[:800])
    said = told("pose", manifest, "-o", out, *words, code=1)["warnings"]
    assert len(said) == 1 and "less than other nodes" in said[0], said


@case
def a_node_that_is_lost_is_told_and_too_few_are_refused(folder):
    _, manifest = simulated(folder / "sim", seconds=12)
    whole = manifest.read_text()
    manifest.write_text(whole.replace(', ankle_left = "imu_ankle_left.csv"', "")
                        .replace('wrist_left = "', 'LeftForeArm = "'))
    text, _ = done_with(1, "pose", manifest, "--model", SMALL / "two.safetensors", "-o", folder / "a.bvh")
    assert "nodes    4 of 5" in text, text
    assert "warning  ankle_left has no samples: its limb is a guess" in text, text
    manifest.write_text(whole.replace("wrist_left = ", "knee = ").replace("ankle_left = ", "elbow = ")
                        .replace("ankle_right = ", "chest = "))
    first = refused("pose", manifest, "--model", SMALL / "two.safetensors", "-o", folder / "b.bvh", naming=manifest)
    assert first.endswith("expected a node waist and two of wrist_left, wrist_right, ankle_left, ankle_right with samples, "
                          "found waist, knee, wrist_right, elbow, chest"), first


@case
def a_node_on_the_head_takes_the_model_that_knows_of_one(folder):
    if not SHIPPED.exists():
        raise Skip("no models/pose.safetensors")
    _, manifest = simulated(folder / "sim", seconds=12)
    whole = manifest.read_text()
    said = told("pose", manifest, "-o", folder / "five.bvh")
    assert said["model"].endswith("/models/pose.safetensors") and len(said["nodes"]) == 5, said
    manifest.write_text(whole.replace('wrist_right = "', 'head = "imu_waist.csv", wrist_right = "'))
    said = told("pose", manifest, "-o", folder / "six.bvh")
    assert said["model"].endswith("/models/pose_head.safetensors") and "head" in said["nodes"], said


@case
def what_has_no_nodes_or_is_no_model_is_refused(folder):
    walk = folder / "walk.bvh"
    walk.write_text(samples.bvh())
    first = refused("pose", walk, "--model", SMALL / "two.safetensors", "-o", folder / "o.bvh", naming=walk)
    assert first.endswith("expected one stream of inertial nodes (--stream NAME), found none"), first
    take, _ = simulated(folder / "sim", seconds=6)
    first = refused("pose", take, "--model", SMALL / "two.safetensors", "--stream", "kinect", "-o", folder / "o.bvh", naming=take)
    assert first.endswith('expected a stream of inertial nodes "kinect", found imu'), first
    other = ROOT / "tests/data/fuzz/denoise_model_fuzz/one.safetensors"
    first = refused("pose", take, "--model", other, "-o", folder / "o.bvh", naming=other)
    assert first.endswith("expected a model for poses from inertial nodes, found task denoise"), first
    refused("denoise", take, "--model", SMALL / "two.safetensors", "-o", folder / "o.bvh", naming=SMALL / "two.safetensors")
    (folder / "o.bvh").write_text("mine")
    refused("pose", take, "--model", SMALL / "two.safetensors", "-o", folder / "o.bvh", naming=folder / "o.bvh")
    assert (folder / "o.bvh").read_text() == "mine"


@case
def wrong_words_are_told(_):
    wrong("pose", "take.h5", says="-o: expected -o FILE.bvh, found none")
    wrong("pose", "take.h5", "-o", "pose.trc", says="-o: expected -o FILE.bvh, found pose.trc")
    for text in ("3", "a,b", "4,2", "-1,2", "1,2,3"):
        wrong("pose", "take.h5", "-o", "pose.bvh", f"--tpose={text}",
              says=f"--tpose: expected START,END in seconds, such as 1.5,4, found {text}")
    wrong("train", "refine", "--windows", "w.npz", "-o", "m.safetensors", "--nodes", "waist",
          says="--nodes: expected a method for poses or for fusion, found refine")
    wrong("train", "wouda", "--windows", "w.npz", "-o", "m.safetensors", "--rate", "15",
          says="--rate: expected a method that cleans a stream, found wouda, which works at 30 Hz")


@case
def a_model_for_poses_is_trained_on_a_skeleton_alone_and_used(folder):
    if not (BUILD / "apps/kinalign-learn/kinalign-learn").exists():
        raise Skip("kinalign-learn was not built: it needs libtorch-dev")
    cmu_people(folder)
    data_sets.done("split", folder / "set", "--by", "subject", "--test", "0.3", "-o", folder / "set/people.json")
    model = folder / "m.safetensors"
    words = ("train", "wouda", "--data", folder / "set", "--split", folder / "set/people.json", "-o", model, "--nodes",
             "wrist_left,ankle_left,ankle_right,waist", "--jobs", "1", "--json")
    ran = kinalign(*words, memory=1 << 36, seconds=300)
    ran.stderr = b"".join(line for line in ran.stderr.splitlines(True) if not line.startswith(b"kinalign train: warning: "))
    law(ran, words)
    assert ran.returncode == 0, ran.stderr
    shown = told("info", model)
    assert (shown["task"], shown["method"], shown["rate_hz"]) == ("pose", "wouda", 30), shown
    assert shown["input"]["nodes"] == ["wrist_left", "ankle_left", "ankle_right", "waist"], shown["input"]
    assert len(shown["output"]["bones"]) == 15 and 1.2 < shown["output"]["height_m"] < 1.7, shown["output"]
    assert 0 < shown["metrics"]["clean_position_cm"] < 20, shown["metrics"]
    assert len(shown["training"]["data"][0]["subjects"]) == 2, shown["training"]
    take, _ = simulated(folder / "sim", seconds=6)
    said = told("pose", take, "--model", model, "-o", folder / "o.bvh")
    assert said["joints"] == 27 and "wrist_right" not in said["nodes"], said


@case
def a_suits_skeleton_teaches_poses_too(folder):
    if not (BUILD / "apps/kinalign-learn/kinalign-learn").exists():
        raise Skip("kinalign-learn was not built: it needs libtorch-dev")
    data = data_sets.small_set(folder, takes=1)
    data_sets.done("build", data)
    words = ("train", "wouda", "--data", data, "-o", folder / "m.safetensors", "--jobs", "1")
    ran = kinalign(*words, memory=1 << 36, seconds=300)
    ran.stderr = b"".join(line for line in ran.stderr.splitlines(True) if not line.startswith(b"kinalign train: warning: "))
    law(ran, words)
    assert ran.returncode == 0, ran.stderr
    assert told("info", folder / "m.safetensors")["method"] == "wouda"


sys.exit(main())
