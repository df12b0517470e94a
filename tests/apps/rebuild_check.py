# SPDX-License-Identifier: Apache-2.0
"""The same input gives the same bytes, and another input or parameter is noticed.
rebuild_check.py BUILD_FOLDER [CASE...]"""
import json
import os
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import h5py
import samples
from cases import case, demo, kinalign, law, main


def aligned(manifest, out, **how):
    words = ("align", manifest, "-o", out)
    done = kinalign(*words, **how)
    said = law(done, words)
    assert done.returncode == 0, said
    return out.read_bytes()


def verified(take, inputs):
    words = ("rebuild", take, "--inputs", inputs, "--verify", "--json")
    done = kinalign(*words)
    said = law(done, words)
    assert done.returncode in (0, 1), said
    return done.returncode, json.loads(done.stdout)


@case
def the_same_take_has_the_same_bytes_wherever_and_by_whomever_it_is_made(folder):
    demo(folder / "d", seconds=2)
    first = aligned(folder / "d/recording.toml", folder / "a.h5")
    shutil.copytree(folder / "d", folder / "else where/deeper")
    there = folder / "else where"
    old = os.umask(0o077)
    try:
        again = aligned(pathlib.Path("deeper/recording.toml"), pathlib.Path(there / "b.h5"), cwd=there,
                        env={"TZ": "Pacific/Kiritimati", "LANG": "de_DE.UTF-8", "LC_ALL": "fr_FR.UTF-8",
                             "HOME": "/nowhere", "USER": "someone"})
    finally:
        os.umask(old)
    assert first == again, "another folder, zone, language or umask gives other bytes"
    assert aligned(pathlib.Path("recording.toml"), folder / "c.h5", cwd=there / "deeper") == first
    assert str(folder).encode() not in first, "a folder's name stands in the take"


@case
def the_number_of_threads_changes_no_byte(folder):
    demo(folder / "d", seconds=150)  # several slabs
    takes = []
    for jobs in ("1", "2", "7"):
        out = folder / f"{jobs}.h5"
        done = kinalign("align", folder / "d/recording.toml", "-o", out, "--jobs", jobs)
        assert done.returncode == 0, done.stderr
        takes.append(out.read_bytes())
    assert takes[0] == takes[1] == takes[2]


@case
def a_take_is_remade_to_the_byte_and_one_changed_input_byte_is_named(folder):
    demo(folder / "d", seconds=2)
    take = folder / "t.h5"
    aligned(folder / "d/recording.toml", take)
    code, said = verified(take, folder / "d")
    assert (code, said["same"], said["changed_inputs"]) == (0, True, []), said
    for name in ("mocap.bvh", "kinect.csv", "imu_waist.csv"):
        whole = (folder / "d" / name).read_bytes()
        changed = bytearray(whole)
        at = len(whole) * 3 // 4
        while not (48 <= changed[at] <= 56 and changed[at - 1] != 44):
            at += 1
        changed[at] += 1
        (folder / "d" / name).write_bytes(changed)
        code, said = verified(take, folder / "d")
        assert code == 1 and said["changed_inputs"] == [name], (name, code, said)
        (folder / "d" / name).write_bytes(whole)
    (folder / "d/kinect.csv").unlink()
    done = kinalign("rebuild", take, "--inputs", folder / "d", "--verify")
    assert done.returncode == 3 and b"kinect.csv" in done.stderr, done.stderr


@case
def a_changed_layout_is_named_and_files_of_one_name_are_told_apart(folder):
    layout = ('name = "lab"\nheader = false\nrate_hz = 10\nmetres_per_unit = {}\n[joints]\nnames = ["a"]\n'
              'fields = ["x", "y", "z"]\n')
    manifest = ""
    for name, row in (("one", "1,2,3\n"), ("two", "4,5,6\n")):
        (folder / name).mkdir()
        (folder / name / "p.csv").write_text(row * 20)
        manifest += f'[stream.{name}]\nfile = "{name}/p.csv"\nlayout = "lab.toml"\n'
    (folder / "recording.toml").write_text(manifest)
    (folder / "lab.toml").write_text(layout.format(1))
    take = folder / "t.h5"
    aligned(folder / "recording.toml", take)
    with h5py.File(take) as file:
        assert [n.decode() for n in file["two"].attrs["input_names"]] == ["two/p.csv", "lab.toml"]
    code, said = verified(take, folder)
    assert (code, said["changed_inputs"]) == (0, []), said
    (folder / "lab.toml").write_text(layout.format(0.5))
    code, said = verified(take, folder)
    assert code == 1 and set(said["changed_inputs"]) == {"lab.toml"}, said
    (folder / "lab.toml").write_text(layout.format(1))
    (folder / "two/p.csv").write_text("1,2,3\n" * 20)
    code, said = verified(take, folder)
    assert code == 1 and said["changed_inputs"] == ["two/p.csv"], said


@case
def one_parameter_altered_in_the_take_is_noticed(folder):
    manifest = samples.recording(folder / "r")
    take = folder / "t.h5"
    whole = aligned(manifest, take)
    for key, old, new, says in (("gap_ms", 0.0, 20.0, b"the inputs are the same"),
                                ("rotations", "spline", "slerp", b"the inputs are the same"),
                                ("reference", "mocap", "nothing", b"differs: the take can't be made again: ")):
        take.write_bytes(whole)
        with h5py.File(take, "r+") as file:
            text = file["parameters_json"][()].decode().rstrip("\0")
            parameters = json.loads(text)
            assert parameters["align"][key] == old, parameters["align"]
            parameters["align"][key] = new
            text = json.dumps(parameters)
            del file["parameters_json"]
            file.create_dataset("parameters_json", data=text, dtype=h5py.string_dtype("utf-8", len(text)))
        words = ("rebuild", take, "--inputs", folder / "r", "--verify")
        done = kinalign(*words)
        said = law(done, words)
        assert done.returncode == 1 and says in done.stdout, said
    for at in range(100, len(whole), 997):  # and any byte at all
        changed = bytearray(whole)
        changed[at] ^= 4
        take.write_bytes(changed)
        words = ("rebuild", take, "--inputs", folder / "r", "--verify")
        done = kinalign(*words)
        law(done, words)
        assert done.returncode != 0, f"byte {at} changed, and every byte agrees?"


@case
def an_input_that_is_not_there_is_an_error_with_what_to_do(folder):
    demo(folder, seconds=2)
    (folder / "none").mkdir()
    aligned(pathlib.Path("recording.toml"), folder / "t.h5", cwd=folder)
    for words in (("--verify",), ("-o", "again.h5")):  # a short path, as people type it
        done = kinalign("rebuild", "t.h5", "--inputs", "none", *words, cwd=folder)
        assert done.returncode == 3, done
        said = done.stderr.decode()
        assert "none/mocap.bvh: expected a readable file" in said, said
        assert "--inputs must be one folder with all 7 files of the take" in said, said


@case
def stamps_of_1970_and_of_2200_are_kept_to_the_nanosecond(folder):
    for start in (0, 7_258_118_400_000_000_001, -1_000_000_000, 3_999_999_000_000_000_000):
        samples.recording(folder)
        (folder / "mocap.bvh").write_text(samples.bvh(4, "0.033333333"))
        (folder / "kinect.csv").write_text(samples.kinect(4, start))
        (folder / "imu.csv").write_text(samples.imu(4, start))
        text = samples.manifest().replace("start_ns = 0", f"start_ns = {start}")
        (folder / "recording.toml").write_text(text)
        words = ("align", folder / "recording.toml", "-o", folder / "t.h5", "--force")
        done = kinalign(*words)
        said = law(done, words)
        if done.returncode == 3:  # beyond +-4e18 ns
            assert abs(start) > 4e18, said
            continue
        with h5py.File(folder / "t.h5") as take:
            assert list(take["time_ns"]) == [start + i * samples.STEP for i in range(4)], start
            assert list(take["kinect/nearest_raw_ns"]) == [0] * 4


if __name__ == "__main__":
    sys.exit(main())
