# SPDX-License-Identifier: Apache-2.0
"""A data set from raw files to the paper's tables.
dataset_check.py BUILD_FOLDER [CASE...]"""
import csv
import io
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import PROGRAM, case, kinalign, law, main, nobody
from data_sets import answer, contents, done, recorded, small_set

import hfut


@case
def a_catalogue_of_the_papers_composition_prints_its_tables_from_takes_on_disk(folder):
    takes = hfut.composition(divisor=100, longest=2_000)
    takes = [take for take in takes if take[2] >= 60]  # a second of raw files at least
    assert len(takes) > 20, takes
    done("init", folder / "set", "--template", "hfut-mmd")
    for i, (subject, action, frames, kinect, imu) in enumerate(takes):
        manifest, = recorded(folder / f"raw{i}", frames / 60, seed=i)
        for stream, wanted in (("kinect", kinect), ("imu", imu)):
            if not wanted:
                hfut.without(manifest, stream)
        done("add", folder / "set", manifest, "--subject", subject, "--action", action)
    assert answer("build", folder / "set", seconds=600)["made"] == len(takes)
    tables = answer("tables", folder / "set")
    by_class = hfut.sums(takes, lambda take: take[1][:2])
    rows = {row["class"]: [row["mocap"], row["kinect"], row["imu"]] for row in tables["classes"][:-1]}
    assert rows == by_class, (rows, by_class)
    heights = {person: height for ids, _, height, *_ in hfut.PEOPLE for person in ids}
    sexes = {person: sex for ids, sex, *_ in hfut.PEOPLE for person in ids}
    by_person = hfut.sums(takes, lambda take: (sexes[take[0]], heights[take[0]]))
    rows = {(row["sex"], row["height_cm"]): [row["mocap"], row["kinect"], row["imu"]] for row in tables["subjects"][:-1]}
    assert rows == by_person, (rows, by_person)
    order = [(row["height_cm"], row["sex"]) for row in tables["subjects"][:-1]]
    assert order == sorted(order), order
    total = [sum(column) for column in zip(*by_class.values())]
    for name in ("classes", "subjects"):
        last = tables[name][-1]
        assert [last["mocap"], last["kinect"], last["imu"]] == total, last
    own = tables["data_sets"][-1]
    assert (own["frames"], own["clips"]) == (sum(total), len(takes)), own
    together = {row["modalities"]: (row["takes"], row["frames"]) for row in tables["modalities"][:-1]}
    all_three = [take for take in takes if take[3] and take[4]]
    assert together["mocap + Kinect + IMU"] == (len(all_three), sum(take[2] for take in all_three)), together
    latex = done("tables", folder / "set", "--table", "classes", "--format", "latex")
    assert "Baduanjin" in latex and f"{total[0]:,}" in latex, latex


@case
def a_build_makes_what_is_new_or_changed_and_nothing_else(folder):
    data = small_set(folder)
    assert answer("build", data)["made"] == 3
    first = contents(data)
    assert answer("build", data) == {"schema": "kinalign.dataset.build/1", "made": 0, "failed": 0, "up_to_date": 3,
                                     "takes": []}
    raw = sorted((folder / "raw").rglob("kinect.csv"))[0]
    text = raw.read_text()
    raw.write_text(text.replace("1", "1", 1))  # the same bytes, a new date
    assert answer("build", data)["made"] == 0
    lines = text.splitlines(keepends=True)
    raw.write_text("".join(lines[:-1]))
    plan = answer("build", data, "--dry-run")
    assert [(one["name"], one["reason"]) for one in plan["to_make"]] == [
        ("sub-00_task-S2A01_run-01", "its raw files changed")], plan
    assert answer("build", data)["made"] == 1
    raw.write_text(text)
    (data / "dataset.toml").write_text((data / "dataset.toml").read_text() + "\n[align]\nrotations = \"slerp\"\n")
    plan = answer("build", data, "--dry-run")
    assert {one["reason"] for one in plan["to_make"]} == {"its parameters changed"}, plan
    assert len(plan["to_make"]) == 3
    text = (data / "dataset.toml").read_text()
    (data / "dataset.toml").write_text(text.replace("\n[align]\nrotations = \"slerp\"\n", ""))
    assert answer("build", data)["made"] == 1
    assert contents(data) == first


@case
def the_index_is_only_a_cache(folder):
    data = small_set(folder)
    done("build", data)
    listed, first = done("list", data, "--columns", "all"), contents(data)
    shutil.rmtree(data / ".kinalign")
    assert done("list", data, "--columns", "all") == listed
    (data / ".kinalign/index.sqlite").write_bytes(b"no index at all" * 100)
    assert done("list", data, "--columns", "all") == listed
    for summary in data.rglob("*_take.json"):
        summary.unlink()
    assert "3 takes not built" in done("list", data)
    done("build", data)
    assert done("list", data, "--columns", "all") == listed
    assert contents(data) == first
    if os.geteuid() != 0:
        shutil.rmtree(data / ".kinalign")
        data.chmod(0o555)
        assert done("list", data, "--columns", "all") == listed


@case
def lists_and_queries_answer_in_text_csv_and_json_and_change_nothing(folder):
    data = small_set(folder, takes=5)
    done("build", data)
    rows = list(csv.DictReader(io.StringIO(done("list", data, "--format", "csv", "--columns", "name,subject,frames"))))
    assert [row["subject"] for row in rows] == ["00", "01", "02", "03", "04"], rows
    assert {row["frames"] for row in rows} == {str(180 + i) for i in range(len(rows))}, rows
    found = answer("query", data, "subject in ('01', '03') and frames > 100")["takes"]
    assert [row["subject"] for row in found] == ["01", "03"], found
    found = answer("list", data, "--subject", "02", "--modality", "imu", "--class", "S2")["takes"]
    assert [row["name"] for row in found] == ["sub-02_task-S2A03_run-01"], found
    assert answer("list", data, "--class", "S3")["takes"] == []
    sums = answer("query", data, "select class, sum(frames) as frames from takes group by class")["takes"]
    assert sums == [{"class": "S2", "frames": 910}], sums
    nodes = answer("query", data, "select distinct nodes from streams where modality = 'imu'")["takes"]
    assert nodes[0]["nodes"].split() == ["ankle_left", "ankle_right", "waist", "wrist_left", "wrist_right"] or \
        len(nodes[0]["nodes"].split()) == 5, nodes
    for harm in ("frames > 1); delete from take; --", "with x as (select 1) delete from take", "select load_extension('x')",
                 "pragma user_version = 9", "select * from nothing", "frames >", ""):
        done("query", data, harm, code=3)
    assert len(answer("list", data)["takes"]) == 5


@case
def an_id_that_nobody_has_is_an_error_and_a_flag_without_effect_is_wrong_use(folder):
    data = small_set(folder, takes=4)
    raw = sorted((folder / "raw").rglob("kinect.csv"))
    text = raw[1].read_text().splitlines(keepends=True)
    raw[1].write_text("".join(text[:1] + text[1:len(text) // 3]))
    done("build", data, code=None)
    assert [row["subject"] for row in answer("list", data, "--subject", "sub-03")["takes"]] == ["03"]
    for words, wanted in ((("--subject", "3"), "--subject: expected an id of dataset.toml, [subject.ID] (nearest: 03)"),
                          (("--class", "s1"), "--class: expected an id of dataset.toml, [class.ID] (nearest: S1)"),
                          (("--action", "S2A0"), "--action: expected an id of dataset.toml, [action.ID] (nearest: S2A0"),
                          (("--sort", "framess"), "--sort: expected a column (nearest: frames)"),
                          (("--columns", "framess"), "--columns: expected a column (nearest: frames)")):
        ran = kinalign("dataset", "list", data, *words)
        assert ran.returncode == 3 and wanted in law(ran, ("dataset", "list")), ran.stderr
    verdicts = [row["verdict"] for row in answer("list", data, "--sort", "verdict")["takes"]]
    order = ["bad", "usable", "good"]
    assert len(set(verdicts)) > 1 and verdicts == sorted(verdicts, key=order.index), verdicts
    back = [row["verdict"] for row in answer("list", data, "--sort", "verdict-")["takes"]]
    assert back == verdicts[::-1], back
    for words in (("--columns", "name"), ("--sort", "name"), ("--limit", "1")):
        ran = kinalign("dataset", "query", data, "select name from takes", *words)
        assert ran.returncode == 2 and f"{words[0]}: expected this flag only with a condition" in law(ran, ("dataset", "query")), ran
        answer("query", data, "frames > 0", *words)
    text = (data / "dataset.toml").read_text()
    (data / "dataset.toml").write_text(text.replace("[subject.03]", "[subject.99]"))
    assert len(answer("list", data, "--subject", "03")["takes"]) == 1  # a take has it


@case
def a_fault_of_one_take_is_named_and_stops_no_other(folder):
    data = small_set(folder)
    bad = sorted((folder / "raw").rglob("mocap.bvh"))[1]
    bad.write_text(bad.read_text()[:500])
    manifest = next(data.glob("sub-02/*_recording.toml"))
    manifest.write_text("nonsense = 1\n" + manifest.read_text())
    said = answer("build", data, code=1)
    assert (said["made"], said["failed"]) == (1, 2), said
    failed, other = sorted((one for one in said["takes"] if "failed" in one), key=lambda one: one["name"])
    assert other["name"] == "sub-02_task-S2A03_run-01" and "_recording.toml:1: " in other["failed"], other
    assert failed["name"] == "sub-01_task-S2A02_run-01" and "mocap.bvh" in failed["failed"], failed
    said = done("build", data, code=1)
    assert "failed  sub-01_task-S2A02_run-01: " in said, said
    assert len(answer("list", data)["takes"]) == 1


@case
def wrong_use_is_told_with_what_to_do(folder):
    done("init", folder / "set")
    assert b"dataset.toml" in kinalign("dataset", "init", folder / "set").stderr
    manifest, = recorded(folder / "raw", 2)
    for words, wanted in ((("add", folder / "set", manifest, "--subject", "07", "--action", "x"), b"[subject.07]"),
                          (("add", folder / "set", manifest.with_name("kinect.csv")), b"a recording"),
                          (("list", folder / "raw"), b"kinalign dataset init"),
                          (("list", folder / "none"), b"folder"),
                          (("list", folder / "set", "--columns", "frame"), b"frames")):
        ran = kinalign("dataset", *words)
        assert ran.returncode == 3 and wanted in ran.stderr, ran.stderr


@case
def raw_files_come_along_where_that_is_asked_for(folder):
    done("init", folder / "set", "--template", "hfut-mmd")
    manifest, = recorded(folder / "raw", 3)
    done("add", folder / "set", manifest, "--subject", "01", "--action", "S1A01", "--copy")
    shutil.rmtree(folder / "raw")
    done("build", folder / "set")
    first = contents(folder / "set")
    shutil.move(folder / "set", folder / "moved")
    assert answer("build", folder / "moved")["made"] == 0
    done("build", folder / "moved", "--all")
    assert contents(folder / "moved") == first
    assert str(folder).encode() not in b"".join(p.read_bytes() for p in (folder / "moved/sub-01").iterdir())


@case
def what_was_added_once_is_not_added_twice_and_takes_come_as_they_are(folder):
    data = small_set(folder, takes=1)
    manifest = next((folder / "raw").rglob("recording.toml"))
    again = answer("add", data, manifest, "--subject", "00", "--action", "S2A01")["added"]
    assert again == [{"file": str(manifest), "name": "sub-00_task-S2A01_run-01", "was_there": True}], again
    done("build", data)
    take = next(data.rglob("*_take.h5"))
    done("init", folder / "other", "--template", "hfut-mmd")
    done("add", folder / "other", take)
    done("build", folder / "other")
    copied = next((folder / "other").rglob("*_take.h5"))
    assert copied.read_bytes() == take.read_bytes()
    summary = "_take.json"
    assert next((folder / "other").rglob("*" + summary)).read_bytes() == next(data.rglob("*" + summary)).read_bytes()
    assert answer("build", folder / "other")["up_to_date"] == 1


@case
def a_copy_is_never_another_recordings_file(folder):
    done("init", folder / "set", "--template", "hfut-mmd")
    first, second = (recorded(folder / f"raw{k}", 1 + k, seed=k + 1)[0] for k in (0, 1))
    words = ("--subject", "01", "--action", "S1A01", "--copy")
    done("add", folder / "set", first, *words)
    done("rm", folder / "set", "sub-01_task-S1A01_run-01", "--yes")  # the copies stay
    name = answer("add", folder / "set", second, *words)["added"][0]["name"]
    assert name == "sub-01_task-S1A01_run-02", name
    for copy in (folder / f"set/sourcedata/sub-01/{name}").rglob("*.*"):
        assert copy.read_bytes() == next(second.parent.rglob(copy.name)).read_bytes(), copy
    done("build", folder / "set")
    take = next((folder / "set").glob("sub-01/*_take.h5"))
    assert answer("add", folder / "set", take)["added"][0]["was_there"]


@case
def two_that_add_at_once_get_runs_of_their_own(folder):
    done("init", folder / "set", "--template", "hfut-mmd")
    manifests = recorded(folder / "raw", 1, takes=12)
    running = [subprocess.Popen([PROGRAM, "dataset", "add", folder / "set", m, "--subject", "01", "--action", "S1A01"],
                                stdout=subprocess.DEVNULL) for m in manifests]
    assert [one.wait() for one in running] == [0] * 12
    names = sorted(p.name for p in (folder / "set/sub-01").iterdir())
    assert names == [f"sub-01_task-S1A01_run-{k:02}_recording.toml" for k in range(1, 13)], names


@case
def threads_and_shares_and_kills_change_no_byte(folder):
    data = small_set(folder, takes=7, seconds=4)
    plain = shutil.copytree(data, folder / "plain")
    done("build", plain, "--jobs", "1")
    wanted = contents(plain)
    for jobs in (2, 4):
        other = shutil.copytree(data, folder / f"jobs{jobs}")
        done("build", other, "--jobs", str(jobs))
        assert contents(other) == wanted, jobs
    for size in (2, 3):
        other = shutil.copytree(data, folder / f"ranks{size}")
        made = [answer("build", other, env={"RANK": str(rank), "WORLD_SIZE": str(size)})["made"] for rank in range(size)]
        assert sum(made) == 7 and min(made) > 0, made
        assert contents(other) == wanted, size
    killed = shutil.copytree(data, folder / "killed")
    times = random.Random(1)
    for _ in range(50):
        running = subprocess.Popen([PROGRAM, "dataset", "build", killed, "--all"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        time.sleep(times.uniform(0, 0.5))
        running.send_signal(signal.SIGKILL)
        running.wait()
    done("build", killed)
    left = {name for name in contents(killed) if name not in wanted}
    assert not left, left
    assert contents(killed) == wanted


@case
def verify_finds_any_byte_that_was_altered_and_what_belongs_to_nothing(folder):
    data = small_set(folder, takes=2)
    done("build", data)
    found = answer("verify", data)
    assert {one["severity"] for one in found["findings"]} <= {"note"} and found["takes"] == 2, found
    answer("verify", data, "--deep")
    random_byte = random.Random(7)
    for path in sorted(data.glob("sub-*/*")):
        if path.name.endswith("_recording.toml"):
            continue
        bytes_ = path.read_bytes()
        for _ in range(12):
            at = random_byte.randrange(len(bytes_))
            path.write_bytes(bytes_[:at] + bytes([bytes_[at] ^ (1 << random_byte.randrange(8))]) + bytes_[at + 1:])
            ran = kinalign("dataset", "verify", data, "--json")
            assert ran.returncode == 1, (path.name, at, ran.stdout[-500:], ran.stderr)
            assert any(one["severity"] == "error" and one["file"].startswith(f"{path.parent.name}/")
                       for one in json.loads(ran.stdout)["findings"]), (path.name, at, ran.stdout)
        path.write_bytes(bytes_[:-1])
        assert kinalign("dataset", "verify", data).returncode == 1, path
        path.write_bytes(bytes_)
    (data / "sub-00/notes.txt").write_text("x")
    (data / "old").mkdir()
    said = answer("verify", data)
    assert {one["file"] for one in said["findings"] if "an unknown file" in one["found"]} == {"sub-00/notes.txt", "old"}, said
    manifest = next(data.glob("sub-01/*_recording.toml"))
    manifest.write_text(manifest.read_text().replace("[align]\n", "[align]\nrotations = \"slerp\"\n"))
    raw = sorted((folder / "raw").rglob("kinect.csv"))
    text = raw[0].read_text()
    raw[0].unlink()
    said = answer("verify", data, code=1)
    wrong = {(one["severity"], one["file"].split("/")[0], one["expected"].split(" that")[0]) for one in said["findings"]
             if one["severity"] != "note"}
    assert wrong == {("warning", "sub-01", "the parameters of the take"), ("warning", "sub-00", "the raw file kinect.csv")}, wrong
    raw[0].write_text(text.replace("0", "1", 1))
    assert kinalign("dataset", "verify", data).returncode == 1  # the parameters
    said = answer("verify", data, "--deep", code=1)
    assert any("the raw file that the take was made from" in one["expected"] and one["severity"] == "error" for one in said["findings"]), said
    next(data.glob("sub-01/*_take.h5")).unlink()
    said = answer("verify", data, code=1)
    assert any(one["expected"] == "a take with this name" for one in said["findings"]), said


@case
def a_folder_that_may_not_be_read_is_an_error_and_hides_no_take(folder):
    prefix = nobody()
    data = small_set(folder)
    done("build", data)
    shutil.rmtree(data / ".kinalign")
    folder.chmod(0o755)
    manifest = next((folder / "raw").rglob("recording.toml"))
    verbs = [("list", data), ("tables", data), ("split", data, "-o", folder / "s.json"), ("verify", data),
             ("export", data, "-o", folder / "out"), ("windows", data, "-o", folder / "w.npz"), ("build", data),
             ("report", data), ("rm", data, "sub-01", "--yes"), ("rename", data, "sub-01", "sub-09")]
    writing = [("add", data, manifest, "--subject", "01", "--action", "S1A01"), ("import", data, folder / "raw")]
    for place, mode, words in ((data / "sub-01", 0o700, verbs), (data / "sub-01", 0o704, verbs[:4]),
                               (data, 0o700, verbs + writing)):
        place.chmod(mode)
        for one in words:
            ran = kinalign("dataset", *one, prefix=prefix)
            told = law(ran, ("dataset", *one))
            is_verify = one[0] == "verify" and mode == 0o704  # names the takes that it can't read
            assert ran.returncode == (1 if is_verify else 3) and (is_verify or "Permission denied" in told), told
        place.chmod(0o755)
    assert len(answer("list", data)["takes"]) == 3


@case
def sourcedata_that_may_not_be_read_stops_no_check_and_no_raw_file_is_forgotten(folder):
    prefix = nobody()
    done("init", folder / "set", "--template", "hfut-mmd")
    data, (manifest,) = folder / "set", recorded(folder / "raw", 2)
    done("add", data, manifest, "--subject", "01", "--action", "S1A01", "--copy")
    done("build", data)
    folder.chmod(0o755)
    (data / "sourcedata").chmod(0o700)
    said = json.loads(kinalign("dataset", "verify", data, "--json", prefix=prefix).stdout)
    assert said["takes"] == 1 and said["bytes"] > 0, said
    finding, = [one for one in said["findings"] if one["file"] == "sourcedata"]
    assert (finding["severity"], finding["found"]) == ("warning", "Permission denied"), finding
    ran = kinalign("dataset", "rm", data, "sub-01", "--raw", "--yes", "--dry-run", prefix=prefix)
    assert ran.returncode == 3 and b"sourcedata" in ran.stderr, ran


@case
def a_split_after_a_build_is_a_line_and_hides_no_leak(folder):
    data = small_set(folder, takes=10, seconds=1)
    done("build", data)
    (data / "splits").mkdir()
    split = data / "splits/people.json"
    done("split", data, "--by", "subject", "--test", "0.3", "-o", split)
    (data / "dataset.toml").write_text((data / "dataset.toml").read_text() + "\n[align]\nrotations = \"slerp\"\n")
    assert answer("build", data, code=None)["made"] == 10
    found, = [one for one in answer("verify", data)["findings"] if one["file"] == "splits/people.json"]
    assert found["severity"] == "note" and "10 made again" in found["found"] and "--force" in found["repair"], found
    parts = json.loads(split.read_text())
    parts["parts"][1]["takes"].append(parts["parts"][0]["takes"][0])
    split.write_text(json.dumps(parts))
    assert "in one part" in done("split", data, "--check", split, code=1).splitlines()[0]
    kinds = [one["severity"] for one in answer("split", data, "--check", split, code=1)["findings"]]
    assert len(kinds) > 1 and kinds == ["error"] * (len(kinds) - 1) + ["warning"], kinds
    files = [one["file"] for one in answer("verify", data, code=1)["findings"] if one["severity"] == "error"]
    assert files == ["splits/people.json"], files


@case
def two_builds_at_once_lose_nothing(folder):
    data = small_set(folder, takes=6)
    plain = shutil.copytree(data, folder / "plain")
    done("build", plain)
    running = [subprocess.Popen([PROGRAM, "dataset", "build", data], stdout=subprocess.DEVNULL) for _ in range(2)]
    assert [one.wait() for one in running] == [0, 0]
    assert contents(data) == contents(plain)
    assert len(answer("list", data)["takes"]) == 6


if __name__ == "__main__":
    sys.exit(main())
