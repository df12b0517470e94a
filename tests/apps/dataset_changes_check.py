# SPDX-License-Identifier: Apache-2.0
"""Takes of a data set renamed and removed. dataset_changes_check.py BUILD_FOLDER [CASE...]"""
import json
import os
import pathlib
import pty
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import PROGRAM, case, kinalign, main
from data_sets import answer, contents, done, recorded, shared


def built_set(folder, takes=4, copied=True):
    done("init", folder / "set", "--template", "hfut-mmd")
    for i in range(takes):  # of lengths that differ, so that no raw files are alike
        manifest, = recorded(folder / "raw" / f"{i}", 2 + i / 60, seed=i + 1)
        done("add", folder / "set", manifest, "--subject", f"{i // 2 + 1:02}", "--action", f"S2A{i + 1:02}",
             *["--copy"] * copied)
    done("build", folder / "set")
    return folder / "set"


def faults(data):
    return [one for one in answer("verify", data)["findings"] if one["severity"] != "note"]


@case
def a_renamed_person_is_another_data_set_only_by_name(folder):
    data = built_set(folder)
    toml = (data / "dataset.toml").read_text()
    (data / "dataset.toml").write_text(toml.replace("[subject.01]", "[subject.01]  # the first"))
    before = answer("list", data)["takes"]
    said = answer("rename", data, "sub-01", "sub-21")
    assert (said["moved"], said["to_build"], len(said["takes"])) == (0, 2, 2), said
    assert "[subject.21]  # the first" in (data / "dataset.toml").read_text()
    plan = answer("build", data, "--dry-run")
    assert {(one["name"][:6], one["reason"]) for one in plan["to_make"]} == {("sub-21", "new")}, plan
    assert answer("build", data)["made"] == 2
    assert faults(data) == []
    again = [{**row, "name": row["name"].replace("sub-21", "sub-01"), "subject": row["subject"].replace("21", "01")}
             for row in answer("list", data)["takes"]]
    assert sorted(again, key=lambda row: row["name"]) == before
    assert not list(data.rglob("*sub-01*"))
    # The other way round it is byte by byte what it was.
    answer("rename", data, "sub-21", "sub-01")
    (data / "dataset.toml").write_text(toml)
    done("build", data)
    fresh = built_set(folder / "other")
    assert contents(data) == contents(fresh)


@case
def a_take_and_an_action_are_renamed_too_and_splits_are_told(folder):
    data = built_set(folder)
    (data / "splits").mkdir()
    kinalign("dataset", "split", data, "--by", "take", "--test", "0.3", "-o", data / "splits/a.json")
    take = data / "sub-01/sub-01_task-S2A01_run-01_take.h5"
    bytes_ = take.read_bytes()
    said = done("rename", data, "sub-01_task-S2A01_run-01", "sub-01_task-S2A01_run-09")
    assert "splits/a.json names 1 of these takes" in said, said
    assert (data / "sub-01/sub-01_task-S2A01_run-09_take.h5").read_bytes() == bytes_ and not take.exists()
    assert answer("build", data)["made"] == 0, "a take that only has another run is made again"
    (data / "dataset.toml").write_text((data / "dataset.toml").read_text().replace("[action.S2A07]", "# [action.S2A07]"))
    text = (data / "dataset.toml").read_text()
    (data / "dataset.toml").write_text(re.sub(r'# \[action\.S2A07\]\nclass = "S2"\nname = ""\n', "", text))
    assert answer("rename", data, "S2A01", "S2A07")["to_build"] == 1
    done("build", data)
    ran = kinalign("dataset", "verify", data, "--json")
    assert ran.returncode == 1 and {one["file"] for one in json.loads(ran.stdout)["findings"]
                                      if one["severity"] != "note"} == {"splits/a.json"}, ran.stdout
    (data / "splits/a.json").unlink()
    assert faults(data) == []
    assert [row["action"] for row in answer("list", data, "--subject", "01")["takes"]] == ["S2A02", "S2A07"]


@case
def a_rename_that_was_killed_is_told_and_finished(folder):
    data = built_set(folder, takes=6)
    wanted = shutil.copytree(data, folder / "wanted")
    done("rename", wanted, "sub-01", "sub-21")
    times, unfinished = random.Random(3), 0
    for _ in range(30):
        killed = folder / "killed"
        shutil.copytree(data, killed)
        running = subprocess.Popen([PROGRAM, "dataset", "rename", killed, "sub-01", "sub-21"], stdout=subprocess.DEVNULL)
        time.sleep(times.uniform(0, 0.02))
        running.send_signal(signal.SIGKILL)
        running.wait()
        if (killed / "unfinished_rename.json").exists():
            unfinished += 1
            ran = kinalign("dataset", "verify", killed)
            assert ran.returncode == 1 and b"run the same kinalign dataset rename again" in ran.stdout, ran.stdout
            ran = kinalign("dataset", "rename", killed, "sub-02", "sub-22")
            assert ran.returncode == 3 and b"dataset rename " in ran.stderr, ran.stderr
        if "sub-21" not in os.listdir(killed) or (killed / "unfinished_rename.json").exists():
            done("rename", killed, "sub-01", "sub-21")
        left = {name: hash_ for name, hash_ in contents(killed).items() if not name.endswith(".part")}
        assert left == contents(wanted)
        shutil.rmtree(killed)
    print(f"({unfinished} of 30 kills left a rename half done)")


@case
def rm_says_what_goes_and_asks(folder):
    data = built_set(folder, takes=2)
    name = "sub-01_task-S2A01_run-01"
    files = [p for p in (data / "sub-01").iterdir() if name in p.name]
    before = contents(data)
    ran = kinalign("dataset", "rm", data, name)
    assert ran.returncode == 2 and b"--yes" in ran.stderr, ran.stderr
    said = answer("rm", data, name, "--dry-run")
    assert said["removed"] is False and said["bytes"] == sum(p.stat().st_size for p in files), said
    assert contents(data) == before
    for reply, is_gone in ((b"n\n", False), (b"\n", False), (b"y\n", True)):
        parent, child = pty.openpty()
        running = subprocess.Popen([PROGRAM, "dataset", "rm", data, name], stdin=child, stdout=child, stderr=child)
        os.close(child)
        os.write(parent, reply)
        assert running.wait(60) == 0
        text = os.read(parent, 65536).decode()
        os.close(parent)
        assert "remove these files permanently? [y/N]" in text and f"{name}" in text, text
        assert all(p.exists() != is_gone for p in files), text
    assert (data / "sourcedata/sub-01" / name).exists()
    said = answer("rm", data, name, "sub-01_task-S2A02_run-01", "--raw", "--yes")
    assert len(said["takes"]) == 2 and not list(data.rglob("sub-01*")), said
    assert answer("list", data)["takes"] == []


@case
def raw_files_outside_the_data_set_stay(folder):
    data = built_set(folder, takes=2, copied=False)
    raw = contents(folder / "raw")
    answer("rename", data, "sub-01", "sub-21")
    assert answer("build", data)["made"] == 2
    answer("rm", data, "sub-21", "--raw", "--yes")
    assert contents(folder / "raw") == raw
    assert not list(data.glob("sub-*"))


@case
def raw_files_of_an_unpacked_corpus_go_and_verify_names_those_of_no_take(folder):
    source = shared("ui_prmd") / "original"
    data = folder / "set"
    with zipfile.ZipFile(folder / "prmd.zip", "w") as packed:
        for path in [*source.rglob("*_positions.txt"), *source.glob("Kinect/Angles/*.txt")]:
            packed.write(path, path.relative_to(source))
    assert answer("import", data, folder / "prmd.zip")["added"] == 2
    done("build", data)
    first, second = sorted(path.name[:-len("_take.h5")] for path in data.glob("sub-*/*.h5"))
    before = contents(data)
    left = answer("rm", data, first, "--dry-run")["raw_left"]
    assert len(left) == 3 and all((data / path).is_file() for path in left), left
    answer("rm", data, first, "--raw", "--yes")
    gone = {name for name in before if name not in contents(data)}
    assert set(left) <= gone, gone
    assert not [one for one in answer("verify", data)["findings"] if one["file"] == "sourcedata"]
    (data / "sourcedata/more.txt").write_text("x")
    finding, = [one for one in answer("verify", data)["findings"] if one["file"] == "sourcedata"]
    assert (finding["severity"], finding["found"]) == ("note", "1 other files: sourcedata/more.txt"), finding
    (data / "sourcedata/more.txt").unlink()
    answer("rm", data, second, "--raw", "--yes")
    assert not (data / "sourcedata").exists(), list(data.rglob("*"))


if __name__ == "__main__":
    sys.exit(main())
