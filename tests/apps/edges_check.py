# SPDX-License-Identifier: Apache-2.0
"""Recordings at the edges: what moves, turns, is permuted, is nearly empty or only just touches.
edges_check.py BUILD_FOLDER [CASE...]"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import h5py
import numpy as np

import samples
from cases import case, demo, kinalign, law, main, refused

HOUR = 3_600_000_000_000


def made(manifest, out, *flags):
    """The report of a take that was made."""
    words = ("align", manifest, "-o", out, "--force", "--json", *flags)
    done = kinalign(*words)
    said = law(done, words)
    report = json.loads(done.stdout)["report"]
    code = int(any(f["severity"] != "note" for f in report["findings"]))
    assert done.returncode == code, said
    assert kinalign("check", out).returncode == code, "check finds other faults with it"
    return report


def arrays(path):
    out = {}
    with h5py.File(path) as take:
        take.visititems(lambda name, item: out.update({name: item[()]}) if isinstance(item, h5py.Dataset)
                        and not name.endswith("json") else None)
    return out


def change_rows(path, change):
    """Each row of a CSV through change(cells, index); None drops it."""
    head, *rows = path.read_text().splitlines()
    changed = [change(row.split(","), i) for i, row in enumerate(rows)]
    path.write_text("\n".join([head, *(",".join(c) for c in changed if c is not None)]) + "\n")


def put(folder, **texts):
    """Writes streams and a manifest of them, in this order; NAME_options go into its table."""
    folder.mkdir(exist_ok=True)
    manifest = ""
    for name, text in texts.items():
        if name.endswith("_options"):
            continue
        ending = ".bvh" if text.startswith("HIERARCHY") else ".csv"
        (folder / (name + ending)).write_text(text)
        manifest += f'[stream.{name}]\nfile = "{name}{ending}"\n{texts.get(name + "_options", "")}\n'
    (folder / "recording.toml").write_text(manifest)
    return folder / "recording.toml"


@case
def everything_an_hour_later_is_the_same_take_an_hour_later(folder):
    demo(folder, seconds=3)
    made(folder / "recording.toml", folder / "a.h5", "--double")
    for path in folder.glob("*.csv"):
        change_rows(path, lambda c, i: [str(int(c[0]) + HOUR), *c[1:]])
    text = (folder / "recording.toml").read_text()
    for key in ("start_ns", "end_ns"):
        old = text.split(f"{key} = ")[1].split("\n")[0]
        text = text.replace(f"{key} = {old}", f"{key} = {int(old) + HOUR}")
    (folder / "recording.toml").write_text(text)
    made(folder / "recording.toml", folder / "b.h5", "--double")
    before, after = arrays(folder / "a.h5"), arrays(folder / "b.h5")
    for name, values in before.items():
        if name in ("time_ns", "t0_ns"):
            assert (after[name] == values + HOUR).all()
        else:
            assert np.array_equal(after[name], values), name


@case
def the_order_of_streams_in_the_manifest_changes_no_number(folder):
    demo(folder, seconds=3)
    first = made(folder / "recording.toml", folder / "a.h5", "--double")
    text = (folder / "recording.toml").read_text()
    parts = ["[" + p for p in text.split("\n[")]
    (folder / "recording.toml").write_text("\n".join([parts[0][1:], *reversed(parts[1:])]))
    second = made(folder / "recording.toml", folder / "b.h5", "--double")
    before, after = arrays(folder / "a.h5"), arrays(folder / "b.h5")
    assert before.keys() == after.keys()
    for name, values in before.items():
        assert np.array_equal(after[name], values), name
    assert sorted(map(str, first["streams"])) == sorted(map(str, second["streams"]))


@case
def a_turned_and_moved_sensor_gives_the_same_points_in_the_takes_space(folder):
    demo(folder, seconds=3)
    made(folder / "recording.toml", folder / "a.h5", "--double")
    c, s = np.cos(1.1), np.sin(1.1)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]])

    def turned(cells, _):
        for j in range(25):
            p = turn @ np.array(cells[1 + 4 * j:4 + 4 * j], float) + (0.5, -2.0, 7.0)
            cells[1 + 4 * j:4 + 4 * j] = [f"{x:.12f}" for x in p]
        return cells
    change_rows(folder / "kinect.csv", turned)
    made(folder / "recording.toml", folder / "b.h5", "--double")
    before, after = arrays(folder / "a.h5"), arrays(folder / "b.h5")
    assert np.abs(before["kinect/positions"] - after["kinect/positions"]).max() < 1e-9
    assert np.array_equal(before["kinect/valid"], after["kinect/valid"])


@case
def a_mirrored_body_is_fitted_by_a_rotation_never_by_a_mirror(folder):
    demo(folder, seconds=3)
    right = made(folder / "recording.toml", folder / "a.h5")["spaces"][0]

    def mirrored(cells, _):
        for j in range(25):
            cells[1 + 4 * j] = str(-float(cells[1 + 4 * j]))
        return cells
    change_rows(folder / "kinect.csv", mirrored)
    wrong = made(folder / "recording.toml", folder / "b.h5")["spaces"][0]
    assert abs(np.linalg.norm(wrong["rotation"]) - 1) < 1e-12
    assert wrong["after_m"] > right["after_m"], (right["after_m"], wrong["after_m"])


@case
def points_and_a_second_sensor_may_be_the_reference(folder):
    put(folder, a=samples.kinect(40), b=samples.kinect(40, 10_000_000))
    report = made(folder / "recording.toml", folder / "t.h5")
    assert (report["frames"], report["reference"]) == (39, "a")
    demo(folder / "d", seconds=3)
    text = (folder / "d/recording.toml").read_text().replace('reference = "mocap"', 'reference = "kinect"')
    (folder / "d/recording.toml").write_text(text.split("[space")[0])
    report = made(folder / "d/recording.toml", folder / "t.h5")
    assert report["reference"] == "kinect"


@case
def one_stream_alone_is_a_take(folder):
    for text, frames in ((samples.bvh(), 4), (samples.kinect(5), 5), (samples.bvh(1), 1),
                         (samples.kinect(1), 1)):
        report = made(put(folder, only=text, only_options="start_ns = 0"), folder / "t.h5")
        assert report["frames"] == frames
    refused("align", put(folder, only=samples.imu()), "-o", folder / "x.h5", naming=f"{folder}/recording.toml: expected a skeleton or points",
            out=folder / "x.h5")
    refused("align", put(folder, only=samples.bvh(0)), "-o", folder / "x.h5",
            naming="only.bvh: expected at least one", out=folder / "x.h5")


@case
def nearly_empty_streams_give_a_take_of_the_instant_they_share(folder):
    begin = "start_ns = 0"
    report = made(put(folder, mocap=samples.bvh(), mocap_options=begin, kinect=samples.kinect(1)), folder / "t.h5")
    assert report["frames"] == 1
    report = made(put(folder, mocap=samples.bvh(1), mocap_options=begin, kinect=samples.kinect(9),
                      imu=samples.imu(9)), folder / "t.h5")
    assert report["frames"] == 1
    # streams that touch at one instant, and ones that miss each other by a nanosecond
    last = 3 * 33_333_300
    report = made(put(folder, mocap=samples.bvh(), mocap_options=begin, kinect=samples.kinect(9, last)),
                  folder / "t.h5")
    assert report["frames"] == 1
    refused("align", put(folder, mocap=samples.bvh(), mocap_options=begin, kinect=samples.kinect(9, last + 1)),
            "-o", folder / "x.h5", naming=f"{folder}/recording.toml: expected streams that overlap", out=folder / "x.h5")
    # one sample of the other stream between two rows of the grid: no row in the common span
    refused("align", put(folder, mocap=samples.bvh(), mocap_options=begin, kinect=samples.kinect(1, 5)),
            "-o", folder / "x.h5", naming=f"{folder}/recording.toml: expected frames of 'mocap'", out=folder / "x.h5")


@case
def an_IMU_without_gyroscope_at_200_Hz_goes_onto_30_Hz(folder):
    imu = "time_ns,qw,qx,qy,qz,ax,ay,az\n" + "".join(
        f"{i * 5_000_000},1,0,0,0,{np.sin(0.02 * i):.6f},9.81,0\n" for i in range(400))
    report = made(put(folder, mocap=samples.bvh(50), mocap_options="start_ns = 0", imu=imu), folder / "t.h5")
    assert report["frames"] == 50 and report["findings"] == []
    with h5py.File(folder / "t.h5") as take:
        assert "angular_velocity" not in take["imu"]
        at = 1e-9 * (take["time_ns"][:])
        assert np.abs(take["imu/acceleration"][:, 0, 0] - np.sin(4 * at)).max() < 1e-5


@case
def a_reference_of_1000_Hz_is_a_grid_like_any_other(folder):
    report = made(put(folder, mocap=samples.bvh(3000, "0.001"), mocap_options="start_ns = 0",
                      kinect=samples.kinect(100)), folder / "t.h5")
    assert report["frames"] == 3000
    with h5py.File(folder / "t.h5") as take:
        assert (take["kinect/valid"][:] == 1).all()


@case
def gaps_at_either_end_and_a_body_lost_for_a_while_are_marked(folder):
    texts = {"mocap": samples.bvh(300, "0.01"), "mocap_options": "start_ns = 0"}
    recording = put(folder, **texts, kinect=samples.kinect(90))
    for lost in (range(1, 30), range(60, 89), range(30, 60)):
        (folder / "kinect.csv").write_text(samples.kinect(90))
        change_rows(folder / "kinect.csv", lambda c, i: None if i in lost else c)
        dropped = made(recording, folder / "t.h5")
        with h5py.File(folder / "t.h5") as take:
            t, valid = take["time_ns"][:], take["kinect/valid"][:]
            inside = (t > (lost[0] - 1) * samples.STEP) & (t < (lost[-1] + 1) * samples.STEP)
            assert (valid[inside] == 0).all() and (valid[~inside] == 1).all(), lost
            assert (take["kinect/positions"][:][valid == 0] == 0).all()
        (folder / "kinect.csv").write_text(samples.kinect(90))

        def unseen(c, i):
            return [c[0], *["" if k % 4 != 3 else "0" for k in range(100)]] if i in lost else c
        change_rows(folder / "kinect.csv", unseen)
        missing = made(recording, folder / "t.h5")
        assert dropped["streams"][1]["gaps"] == 1
        assert missing["streams"][1]["invalid"] == dropped["streams"][1]["invalid"]


@case
def when_the_root_node_is_lost_the_report_counts_all_nodes(folder):
    demo(folder, seconds=4)
    change_rows(folder / "imu_waist.csv", lambda c, i: None if 20 < i < 40 else c)
    report = made(folder / "recording.toml", folder / "t.h5")
    with h5py.File(folder / "t.h5") as take:
        valid = take["imu/valid"][:]
        names = list(take["imu/node_names"].asstr())
    assert (valid == 0).any(0).all()
    for stream in report["streams"]:
        if "nodes" in stream:
            lost = np.count_nonzero(valid[:, [names.index(node) for node in stream["nodes"]]] == 0)
            assert stream["invalid"] == lost, (stream["nodes"], stream["invalid"], lost)


@case
def stamps_that_never_move_are_told(folder):
    text = samples.kinect(40)
    (folder / "kinect.csv").write_text(text)
    change_rows(folder / "kinect.csv", lambda c, i: ["77", *c[1:]])
    done = kinalign("check", folder / "kinect.csv")
    assert done.returncode == 1 and b"the same stamp" in done.stdout, done.stdout
    (folder / "imu.csv").write_text(samples.imu(40))
    change_rows(folder / "imu.csv", lambda c, i: ["77", *c[1:]])
    done = kinalign("check", folder / "imu.csv")
    assert done.returncode == 1 and b"the same stamp" in done.stdout, done.stdout
    recording = put(folder, mocap=samples.bvh(), mocap_options="start_ns = 77",
                    imu=(folder / "imu.csv").read_text())
    assert made(recording, folder / "t.h5")["frames"] == 1


@case
def offsets_and_drifts_of_any_size_end_in_a_take_or_a_message(folder):
    for key in ("offset_ms", "drift_ppm", "interval_ms", "click_latency_ms", "rate_hz", "metres_per_unit",
                "start_ns"):
        for value in ("1e300", "-1e300", "1e12", "-1e12", "1e5", "-1e5", "nan", "inf", "0", "1e-300", "-0.0",
                      "9223372036854775807", "-9223372036854775808", "4000000000000000000", "\"x\"", "true"):
            begin = "" if key == "start_ns" else "start_ns = 0\n"
            recording = put(folder, mocap=samples.bvh(), mocap_options=f"{begin}{key} = {value}",
                            kinect=samples.kinect())
            words = ("align", recording, "-o", folder / "t.h5", "--force", "--json")
            law(kinalign(*words), words)


@case
def a_folder_that_is_gone_is_a_message(folder):
    """The one the program is called from, and the one for temporary files."""
    (folder / "gone").mkdir()
    refused("align", "--mocap", "m.bvh", "--kinect", "k.csv", "-o", "t.h5", naming="m.bvh: expected", cwd=folder,
            prefix=("sh", "-c", 'cd gone && rmdir ../gone && exec "$0" "$@"'))
    made(samples.recording(folder / "r"), folder / "t.h5")
    refused("rebuild", folder / "t.h5", "--inputs", folder / "r", "--verify", naming="TMPDIR: expected a folder",
            env={"TMPDIR": str(folder / "absent")})


if __name__ == "__main__":
    sys.exit(main())
