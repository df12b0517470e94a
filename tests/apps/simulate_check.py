# SPDX-License-Identifier: Apache-2.0
"""What simulate writes and sends is what devices would, and its truth is true.
simulate_check.py BUILD_FOLDER [CASE...]"""
import bisect
import hashlib
import json
import math
import pathlib
import signal
import struct
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
from cases import case, done_with, in_time, kinalign, law, main, refused, wrong
from rehearsing import NODES, recorded, truth_of, truth_table


def simulate(folder, *words, motion="built-in", name="r"):
    out, _ = done_with(0, "simulate", motion, "-o", folder / name, "--json", *words)
    return folder / name, json.loads(out)


def time_of(clock, stamp):
    """A straight line between neighbours, in whole numbers."""
    stamps, times = clock["stamps_ns"], clock["times_ns"]
    i = min(max(bisect.bisect_right(stamps, stamp) - 1, 0), len(stamps) - 2)
    return times[i] + (stamp - stamps[i]) * (times[i + 1] - times[i]) // (stamps[i + 1] - stamps[i])


def digests(folder):
    return {path.relative_to(folder): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def aligned(folder, code=0):
    out, _ = done_with(code, "align", folder / "recording.toml", "-o", folder / "take.h5", "--json")
    return json.loads(out)["report"]


def angle_between(p, q):
    return 2 * math.degrees(math.acos(min(1.0, abs(sum(a * b for a, b in zip(p, q))))))


@case
def what_is_simulated_aligns_at_once_and_the_camera_is_found(folder):
    made, said = simulate(folder, "--seconds", "12")
    report, truth = aligned(made), truth_of(made)
    assert report["frames"] == said["mocap_frames"] == truth["mocap"]["frames"], report["frames"]
    space, camera = report["spaces"][0], truth["kinect"]
    assert space["stream"] == "kinect" and space["after_m"] < 0.12 < 1 < space["before_m"], space
    off = angle_between(space["rotation"], camera["rotation"])
    away = math.dist(space["translation_m"], camera["translation"])
    assert off < 8 and away < 0.25, f"{off:.2f} degrees, {away:.3f} m: {space}"
    assert [node["node"] for node in truth["nodes"]] == NODES, truth["nodes"]
    for stream in report["streams"][1:]:
        assert stream["invalid"] < 0.1 * stream["samples"], stream


@case
def stamps_lie_within_what_the_manifest_says_of_them(folder):
    made, _ = simulate(folder, "--seconds", "20", "--seed", "4")
    truth = truth_of(made)
    interval_ns = 20 * 25e-6 * 1e9 + 1e4
    for clock, file in [(truth["kinect"]["clock"], "kinect.csv"),
                        *((node["clock"], f"imu_{node['node']}.csv") for node in truth["nodes"])]:
        stamps = [int(line.split(",")[0]) for line in (made / file).read_text().splitlines()[1:]]
        assert clock["stamps_ns"][0] == stamps[0] and clock["stamps_ns"][-1] == stamps[-1], file
        worst = max(abs(stamp - time_of(clock, stamp)) for stamp in stamps)
        assert 100 < worst <= interval_ns, f"{file}: {worst} ns"
    manifest = (made / "recording.toml").read_text()
    assert manifest.count("interval_ms = 0.51\n") == 2, manifest


@case
def the_truth_table_finds_all_within_its_interval_and_alignment_adding_little(folder):
    made, _ = simulate(folder, "--seconds", "30", "--seed", "6")
    aligned(made)
    code, said, rows = truth_table(made / "recording.toml", made / "take.h5", made / "truth/truth.json")
    assert code == 0, said
    devices = ["mocap", "kinect"] + [f"imu {node}" for node in NODES]
    assert [row[0] for row in rows] == 2 * devices + ["imu all nodes"], said
    assert all(" 0 of " in row[5] for row in rows[1:7]), said
    for modality in (rows[8], rows[-1]):
        assert float(modality[4].removesuffix("%")) < 5, modality  # the bar: noise alone and 5 % more
    truth = json.loads((made / "truth/truth.json").read_text())
    truth["nodes"][2]["clock"]["times_ns"] = [time + 2_000_000 for time in truth["nodes"][2]["clock"]["times_ns"]]
    (made / "truth/truth.json").write_text(json.dumps(truth))
    code, said, rows = truth_table(made / "recording.toml", made / "take.h5", made / "truth/truth.json")
    assert code == 1 and float(rows[4][2]) > 1.2, said


@case
def the_same_seed_gives_the_same_bytes_another_one_others(folder):
    one, _ = simulate(folder, "--seconds", "4", "--seed", "9", name="one")
    again, _ = simulate(folder, "--seconds", "4", "--seed", "9", name="again")
    other, _ = simulate(folder, "--seconds", "4", "--seed", "10", name="other")
    first, third = digests(one), digests(other)
    assert first == digests(again)
    assert first.keys() == third.keys() and all(first[name] != third[name] for name in first), first.keys()


@case
def arrival_stamps_are_later_by_the_radio_and_align_takes_them(folder):
    made, _ = simulate(folder, "--seconds", "8", "--node-rate", "15", "--node-stamps", "arrival")
    for node in truth_of(made)["nodes"]:
        stamps = [int(line.split(",")[0]) for line in (made / f"imu_{node['node']}.csv").read_text().splitlines()[1:]]
        assert stamps == node["clock"]["stamps_ns"]
        delays = [stamp - time for stamp, time in zip(stamps, node["clock"]["times_ns"])]
        assert min(delays) > 3_300_000 and 20e6 < sum(delays) / len(delays) < 50e6, delays
    assert "offset_ms = -33.2\n" in (made / "recording.toml").read_text()
    done = kinalign("align", made / "recording.toml", "-o", made / "take.h5")
    assert done.returncode in (0, 1), law(done, ["align"])


@case
def a_motion_of_ones_own_is_simulated_as_it_is(folder):
    made, _ = simulate(folder, "--seconds", "5")
    again, said = simulate(folder, "--seconds", "4", motion=made / "truth/motion.bvh", name="again")
    assert said["length_s"] == 4 and truth_of(again)["motion"] == "motion.bvh", said
    aligned(again)
    refused("simulate", made / "kinect.csv", "-o", folder / "none", naming=made / "kinect.csv", out=folder / "none")


@case
def nothing_is_ever_written_over(folder):
    page = " ".join(done_with(0, "simulate", "--help")[0].split())
    assert "new folder to write into; it must not exist yet" in page and "made if need be" not in page, page
    made, _ = simulate(folder, "--seconds", "3")
    before = digests(made)
    refused("simulate", "built-in", "-o", made, naming=f"{made}: expected no file or folder of that name, found an existing one")
    assert digests(made) == before


@case
def wrong_use_is_told(folder):
    wrong("simulate", "built-in", says="--out: expected a new folder's name, found none")
    wrong("simulate", "built-in", "-o", folder / "x", "--to", "127.0.0.1",
          says="--to: expected --live as well, found no --live")
    wrong("simulate", "built-in", "-o", folder / "x", "--live", "--node-stamps", "own",
          says="--node-stamps: expected files, found --live, with which the nodes send their own stamps")
    assert not (folder / "x").exists()


# ---- live

@case
def all_that_is_sent_live_stands_in_the_recording(folder):
    begun, sent, stopped, walk, truth = recorded(folder)
    streams = {stream["stream"]: stream for stream in stopped["streams"]}
    assert streams["mocap"]["frames"] == sent["mocap_frames"] == truth["mocap"]["frames"], stopped
    assert streams["mocap"]["lost"] == streams["kinect"]["refused"] == streams["mocap"]["refused"] == 0, stopped
    assert streams["kinect"]["frames"] == sent["kinect_frames"] == begun["kinect_frames"], stopped
    assert sent["refused"] == 0 and sent["node_samples"] == begun["node_samples"], sent
    nodes = {topic.split("/")[2] for topic, *_ in walk.messages if topic.startswith("/imu/")}
    assert nodes == {"1", "2", "3", "4", "5"}, nodes
    frames = sum(topic.endswith("/raw") and topic.startswith("/imu/") for topic, *_ in walk.messages)
    assert 0.9 * sent["node_frames"] < frames < sent["node_frames"], f"{frames} of {sent}"  # link C loses 2 %
    assert sent["replies"] > 0.85 * frames, sent


@case
def the_suits_clicks_stand_in_the_recording_as_marks(folder):
    _, _, _, walk, truth = recorded(folder, "--begin-in", 1, seconds=4)
    marks = [(log, json.loads(payload)) for topic, _, log, _, payload in walk.messages if topic == "/marks"]
    assert [(mark["kind"], mark["source"], mark["latency_ms"]) for _, mark in marks] == [
        ("start", "call", 53.333333), ("stop", "call", 53.333333)], marks
    for (log, _), click in zip(marks, (truth["mocap"]["start_click_ns"], truth["mocap"]["stop_click_ns"])):
        assert 0 < log - click < 20e6, (log - click) / 1e6


def raw_offset(walk, truth):
    """log_time of a recording -> CLOCK_MONOTONIC_RAW -> the truth's times."""
    own = walk.metadata["kinalign.recording"]
    return int(own["raw_ns"]) - int(own["utc_ns"]) + truth["host"]["utc_ns"] - truth["host"]["raw_ns"]


@case
def no_exchange_contradicts_the_truth_and_samples_were_taken_before_they_came(folder):
    _, _, _, walk, truth = recorded(folder, seconds=8)
    shift, closest = raw_offset(walk, truth), 10**9
    clocks = {str(node["id"]): node["clock"] for node in truth["nodes"]}
    exchanges = samples = 0
    counters = {node: set() for node in clocks}
    for topic, _, log, _, payload in walk.messages:
        if topic.startswith("/imu/") and topic.endswith("/exchange"):
            _, _, echo, t1, t2, t4, t3 = struct.unpack("<QIIqqqq", payload)
            clock, to_truth = clocks[topic.split("/")[2]], truth["host"]["utc_ns"] - truth["host"]["raw_ns"]
            assert time_of(clock, t1) < t2 + to_truth, "a frame arrived before it was sent"
            closest = min(closest, t2 + to_truth - time_of(clock, t1))
            if echo & 1:
                assert t3 + to_truth < time_of(clock, t4) + 1000, "a reply was heard before it was sent"
            exchanges += 1
        elif topic.startswith("/imu/"):
            clock, count = clocks[topic.split("/")[2]], payload[21]
            n_tx = struct.unpack_from(">Q", payload, 24)[0]
            at = 48
            for _ in range(count):
                age, what = struct.unpack_from(">IB", payload, at)
                taken = time_of(clock, 1000 * (n_tx - age))
                counters[topic.split("/")[2]].add(1000 * (n_tx - age))
                assert -1e6 < taken - truth["start_ns"] < 8.01e9 and taken < log + shift, (taken, log)
                at += 5 + 12 * (what & 1) + 12 * (what >> 1 & 1) + 16 * (what >> 2 & 1)
                samples += 1
    assert exchanges > 200 and samples > 2500, (exchanges, samples)
    exact = [stamp in counters[node] for node, clock in clocks.items() for stamp in clock["stamps_ns"]]
    assert sum(exact) > 0.8 * len(exact), f"{sum(exact)} of {len(exact)} samples were taken when they were made for"
    assert 3.3e6 < closest < 9e6, f"{closest / 1e6} ms: the least delay of link C is 3.5"


@case
def nodes_without_a_counter_make_the_papers_exchange(folder):
    _, sent, _, walk, truth = recorded(folder, "--clockless", "--node-rate", "15")
    shift, clocks = raw_offset(walk, truth), {str(node["id"]): node["clock"] for node in truth["nodes"]}
    requests, confirms, halves = 0, 0, []
    for topic, _, log, _, payload in walk.messages:
        if not (topic.startswith("/imu/") and topic.endswith("/raw")):
            continue
        if payload[5] == 3:
            number = struct.unpack_from(">I", payload, 16)[0]
            times = clocks[topic.split("/")[2]]["times_ns"]
            assert log + shift > times[number] + 3.3e6, "a request arrived sooner than its radio lets it"
            requests += 1
        if payload[5] == 5:
            halves.append((log + shift - truth["host"]["utc_ns"] + truth["host"]["raw_ns"]
                           - struct.unpack_from(">Q", payload, 36)[0]) / 2e6)
            confirms += 1
    assert sent["node_samples"] == sent["node_frames"] == 5 * len(clocks["1"]["times_ns"]), sent
    assert requests > 0.9 * sent["node_frames"] and confirms > 0.8 * requests, (requests, confirms)
    in_time(25 < sum(halves) / len(halves) < 45, f"d is {sum(halves) / len(halves)} ms, the paper's 33")


@case
def nodes_without_a_counter_are_aligned_within_three_milliseconds(folder):
    recorded(folder, "--clockless", "--node-rate", "15", seconds=15)
    made, take = folder / "r", next((folder / "takes").glob("*.mcap"))
    text = (made / "recording.toml").read_text()
    assert "rate_hz = 15.0\n" in text and "take_01.mcap" in text, text
    # The devices of this recorder have no skeleton: the camera's stamps are the grid.
    without_suit = text[text.index("[stream.kinect]"):text.index("[space.kinect]")]
    manifest = folder / "recording.toml"
    manifest.write_text(without_suit.replace("take_01.mcap", str(take.resolve())))
    done = kinalign("align", manifest, "-o", folder / "take.h5")
    assert done.returncode in (0, 1), done.stderr
    _, said, rows = truth_table(manifest, folder / "take.h5", made / "truth/truth.json")
    rows = [row for row in rows if row[0].startswith("imu") and len(row) == 6]
    assert len(rows) == 5 and all(int(row[1]) > 150 and row[5] == "none" for row in rows), said
    in_time(all(float(row[2]) < 3 for row in rows), said)  # half of a round trip: 33 in the mean


@case
def frames_of_suit_and_camera_come_some_milliseconds_after_they_were_true(folder):
    _, _, _, walk, truth = recorded(folder)
    shift, late = raw_offset(walk, truth), {"mocap": [], "kinect": []}
    for topic, _, log, _, payload in walk.messages:
        if topic == "/mocap/raw":
            frame = struct.unpack_from("<I", payload, 46)[0]
            true_ns = truth["mocap"]["first_frame_ns"] + round(frame * 1e9 / truth["mocap"]["rate_hz"])
            late["mocap"].append(log + shift - true_ns)
        if topic == "/kinect/raw" and payload[5] == 2:
            device = struct.unpack_from("<q", payload, 24)[0]
            late["kinect"].append(log + shift - time_of(truth["kinect"]["clock"], 100 * device))
    for name, ns in late.items():
        assert len(ns) > 100 and min(ns) > 2e6, f"{name}: {min(ns)}"
        in_time(sorted(ns)[len(ns) // 2] < 4e6, f"{name}: {sorted(ns)[len(ns) // 2]}")


@case
def ctrl_c_ends_a_live_one_in_order_and_nobody_listening_is_told(folder):
    with subprocess.Popen(
            [str(cases.PROGRAM), "simulate", "built-in", "-o", str(folder / "r"), "--live", "--json", "--mocap-port",
             "9", "--kinect-port", "10", "--node-port", "11", "--marks-port", "12"], stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True) as one:
        assert json.loads(one.stdout.readline())["event"] == "sending"
        time.sleep(2)
        one.send_signal(signal.SIGINT)
        out, err = one.communicate(timeout=30)
    assert one.returncode == 130, f"{one.returncode} {err}"
    sent = json.loads(out)
    assert sent["event"] == "sent" and sent["heard"] == 0 and sent["stopped"] and sent["sent_s"] < 60, sent
    assert sent["refused"] > sent["mocap_frames"] + sent["kinect_frames"], sent
    assert truth_of(folder / "r")["length_s"] == 60


sys.exit(main())
