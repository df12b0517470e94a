# SPDX-License-Identifier: Apache-2.0
"""What each verb finds and answers with: exit codes, lines, JSON.
verbs_check.py BUILD_FOLDER [CASE...]"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import samples
from cases import case, demo, done_with, examples, kinalign, main, parsed, refused, typed


def rows_dropped(path, rows):
    """A CSV without these rows, its head counted as row 0."""
    lines = path.read_text().splitlines()
    path.write_text("\n".join(l for i, l in enumerate(lines) if i not in rows) + "\n")


def with_warning(folder):
    """A recording with one row of the mocap cut short, which is a warning, and what makes a take of it."""
    manifest = samples.recording(folder)
    text = (folder / "mocap.bvh").read_text().rstrip("\n")
    (folder / "mocap.bvh").write_text(text[:text.rindex(" ")] + "\n")
    return manifest


@case
def of_a_folder_a_file_in_it_is_named(folder):
    takes = folder / "takes"
    takes.mkdir()
    for verb in (("align", takes, "-o", folder / "t.h5"), ("info", takes), ("check", takes),
                 ("recover", takes, "-o", folder / "whole.mcap")):
        _, err = done_with(3, *verb)
        assert "found a directory\n" in err and err.endswith("\n  name a file in this folder\n"), err
    for name in ("b.mcap", "a.mcap", "0.txt"):
        (takes / name).write_text("")
    for verb in (("align", takes, "-o", folder / "t.h5"), ("info", takes), ("check", takes),
                 ("recover", takes, "-o", folder / "whole.mcap")):
        _, err = done_with(3, *verb)
        assert err.endswith(f"\n  name a file in this folder, such as {takes}/a.mcap\n"), err


@case
def what_was_done_with_a_warning_is_done_with_exit_code_1(folder):
    manifest = with_warning(folder)
    take = folder / "t.h5"
    out, _ = done_with(1, "align", manifest, "-o", take)
    assert "warning  " in out, out
    out, _ = done_with(1, "check", take)
    assert out.startswith(f"warning  {take}: mocap.bvh:") and "incomplete last frame" in out, out
    done_with(1, "check", manifest)
    done_with(0, "rebuild", take, "--inputs", folder, "--verify")
    done_with(1, "rebuild", take, "--inputs", folder, "-o", folder / "again.h5")
    assert (folder / "again.h5").read_bytes() == take.read_bytes()
    for out in ("o.npz", "o.bvh"):
        said, _ = done_with(1, "convert", folder / "mocap.bvh", folder / out)
        assert said.startswith(f"{folder / out}\nwarning  ") and (folder / out).exists(), said
    said, _ = done_with(1, "convert", folder / "mocap.bvh", folder / "p.npz", "--json")
    said = json.loads(said)
    assert said["file"] == str(folder / "p.npz") and len(said["findings"]) == 2, said


@case
def notes_are_told_and_leave_exit_code_0(folder):
    manifest = samples.recording(folder)
    lines = (folder / "kinect.csv").read_text().splitlines()
    (folder / "kinect.csv").write_text("\n".join([*lines, lines[-1]]) + "\n")
    for words in (("check", folder / "kinect.csv"), ("align", manifest, "-o", folder / "t.h5")):
        out, _ = done_with(0, *words)
        assert "note  " in out, out


def first_sample_late(path):
    """Its first stamp a tenth of a millisecond in front of the second one."""
    lines = path.read_text().splitlines()
    second = int(lines[2].split(",", 1)[0])
    lines[1] = f"{second - 100_000}," + lines[1].split(",", 1)[1]
    path.write_text("\n".join(lines) + "\n")
    return second - 100_000


@case
def what_align_warns_of_check_tells_of_the_manifest_as_well(folder):
    demo(folder, seconds=20)
    kinect, node = folder / "kinect.csv", folder / "imu_wrist_left.csv"
    start = first_sample_late(kinect)
    rows = [line.split(",") for line in node.read_text().splitlines()]
    node.write_text("\n".join(",".join([r[0], *r[2:5], r[1], *r[5:]]) if i else ",".join(r)
                              for i, r in enumerate(rows)) + "\n")  # x,y,z,w as w,x,y,z
    manifest = folder / "m.toml"
    manifest.write_text(f'[align]\nreference = "kinect"\n[stream.kinect]\nfile = "kinect.csv"\nstart_ns = {start}\n'
                        '[stream.imu]\nfiles = { wrist_left = "imu_wrist_left.csv" }\n')
    told = []
    for words in (("check", manifest), ("align", manifest, "-o", folder / "t.h5")):
        said = json.loads(done_with(1, *words, "--json")[0])
        told.append([f["expected"] + " " + f["meaning"] for f in (said.get("report") or said)["findings"]])
        for what in ("this stream is the reference, so they keep", "a first sample that was stamped when it was measured", "gravity of 'wrist_left'",
                     "orientations of 'wrist_left' that turn as the gyroscope measures"):
            assert any(what in line for line in told[-1]), (words, what, told[-1])
    assert sorted(told[0]) == sorted(told[1]), told


@case
def findings_name_a_lone_file_as_it_was_typed_and_of_one_file_the_stream(folder):
    demo(folder, seconds=20)
    first_sample_late(folder / "kinect.csv")
    for typed in (folder / "kinect.csv", "kinect.csv", f"../{folder.name}/kinect.csv"):
        said = json.loads(done_with(1, "check", typed, "--json", cwd=folder)[0])
        assert {f["file"] for f in said["findings"]} == {str(typed)}, said
    (folder / "two.toml").write_text("".join(f'[stream.{name}]\nfile = "kinect.csv"\n' for name in ("a", "b")))
    said = json.loads(done_with(1, "check", folder / "two.toml", "--json")[0])
    near = sorted(f["expected"] for f in said["findings"] if "a fifth of a step" in f["expected"])
    assert [line[-7:] for line in near] == [" in 'a'", " in 'b'"], near


@case
def a_stream_that_is_hardly_there_is_told_and_joints_that_are_never_seen_are_not(folder):
    demo(folder, seconds=20)
    lines = [line.split(",") for line in (folder / "kinect.csv").read_text().splitlines()]

    def warned(state_of):
        for i, row in enumerate(lines[1:]):
            for joint in range(25):
                if state_of(i, joint) == 0:
                    row[4 * joint + 4] = "0"
        (folder / "k.csv").write_text("\n".join(map(",".join, lines)) + "\n")
        done = kinalign("align", "--mocap", folder / "mocap.bvh", "--start-ns", 1790000000000000000, "--kinect",
                        folder / "k.csv", "-o", folder / "t.h5", "--force", "--json")
        return [f["expected"] for f in json.loads(done.stdout)["report"]["findings"]]

    assert not any("in most rows" in line for line in warned(lambda i, joint: 0 if 12 <= joint < 20 else 2))
    assert any("samples of 'kinect' in most rows" in line for line in warned(lambda i, joint: 0 if i % 100 < 70 else 2))


@case
def check_refuses_a_manifest_as_align_does(folder):
    manifest = samples.recording(folder)
    good = manifest.read_text()
    for old, new, key, found in (('method = "paper"', 'method = "fit"\njoints = { SpineBase = "Hps" }', "joints",
                             "expected a joint of 'mocap' (nearest: Hips), found \"Hps\""),
                            ("start_ns = 0", "start_ns = 9000000000", None, "expected streams that overlap in time"),
                            ('file = "imu.csv"', 'file = "imu.csv"\nroot_node = "waste"', "root_node",
                             "expected a node of 'imu' for root_node (known: imu), found \"waste\"")):
        assert old in good
        text = good.replace(old, new)
        manifest.write_text(text)
        line = f":{text[:text.index(key)].count(chr(10)) + 1}" if key else ""
        refused("align", manifest, "-o", folder / "t.h5", naming=f"{manifest}{line}: {found}")
        out, _ = done_with(1, "check", manifest)
        assert out.startswith(f"error    {manifest}{line}: {found}"), out
        assert "kinalign align can't make a take of this file" in out, out
        assert ("kinalign info FILE -v lists" in out) == ("overlap" not in found), out


@case
def one_unusable_file_among_many_is_exit_code_3_and_the_others_are_told(folder):
    samples.recording(folder)
    done = kinalign("check", folder / "absent.bvh", folder / "mocap.bvh", "--json")
    said = json.loads(done.stdout)
    assert done.returncode == 3 and len(said["findings"]) == 1, done.stdout
    done = kinalign("check", folder / "absent.bvh", with_warning(folder / "w"))
    assert done.returncode == 3 and b"absent.bvh" in done.stdout and b"mocap.bvh" in done.stdout, done.stdout


@case
def a_rebuild_from_other_inputs_says_which_ones_and_writes(folder):
    manifest = samples.recording(folder)
    take, again = folder / "t.h5", folder / "again.h5"
    done_with(0, "align", manifest, "-o", take)
    (folder / "kinect.csv").write_text(samples.kinect(4).replace("1.3", "1.4", 1))
    done = kinalign("rebuild", take, "--inputs", folder, "-o", again)
    assert done.returncode == 1 and again.exists(), done.stderr
    assert done.stderr.decode() == ("kinalign rebuild: warning: kinect.csv is not the file that the take was made "
                                    "from\n"), done.stderr
    done = kinalign("rebuild", take, "--inputs", folder, "-o", again, "--force", "--json")
    assert json.loads(done.stdout)["changed_inputs"] == ["kinect.csv"] and done.returncode == 1, done.stdout


@case
def a_take_that_cannot_be_made_again_differs(folder):
    manifest = samples.recording(folder)
    take = folder / "t.h5"
    done_with(0, "align", manifest, "-o", take)
    verify = ("rebuild", take, "--inputs", folder, "--verify")
    (folder / "kinect.csv").write_text(samples.kinect(4).replace("1.3,", "x,", 1))
    out, _ = done_with(1, *verify)
    assert out.startswith(f"{take}: differs: the take can't be made again: {folder}/kinect.csv:2: expected "), out
    (folder / "kinect.csv").write_text(samples.kinect(4, 9_000_000_000))
    out, _ = done_with(1, *verify)
    assert "differs: the take can't be made again: expected streams that overlap" in out, out
    assert "kinect.csv is not the file that the take was made from" in out, out
    said = json.loads(done_with(1, *verify, "--json")[0])
    assert said["same"] is False and "overlap" in said["failure"], said
    (folder / "kinect.csv").unlink()
    refused(*verify, naming=folder / "kinect.csv")


@case
def every_verbs_JSON_is_one_object_of_its_schema_in_which_no_name_stands_twice(folder):
    manifest = samples.recording(folder)
    take = folder / "t.h5"
    for words in (("align", manifest, "-o", take), ("info", folder / "mocap.bvh"), ("info", manifest),
                  ("info", take), ("check", take, manifest), ("convert", take, folder / "t.npz"),
                  ("convert", folder / "imu.csv", folder / "i.npz"),
                  ("rebuild", take, "--inputs", folder, "--verify"),
                  ("rebuild", take, "--inputs", folder, "-o", folder / "u.h5"), ("config",)):
        out, _ = done_with(0, *words, "--json")
        said = parsed(out)
        assert list(said)[0] == "schema" and said["schema"] == f"kinalign.{words[0]}/1", out[:200]
        if words[0] == "align":
            assert said["report"]["schema"] == "kinalign.report/1" and said["report"]["frames"] == 4, out


@case
def verbose_lists_names_and_says_what_each_file_was_read_as(folder):
    manifest = samples.recording(folder)
    take = folder / "t.h5"
    done = kinalign("align", manifest, "-o", take, "-v")
    assert done.stderr.decode().splitlines() == [
        "mocap.bvh: read as clip, 2 joints, 1 end site, 4 samples",
        "kinect.csv: read as points, 25 joints, 4 samples",
        "imu.csv: read as nodes, 1 node: orientation, acceleration with gravity, angular velocity, 4 samples",
    ], done.stderr
    for file in (folder / "mocap.bvh", take):
        out, _ = done_with(0, "info", file, "-v")
        assert "           Hips, Spine\n" in out, out
        assert "Hips, Spine" not in done_with(0, "info", file)[0]


@case
def info_gives_first_and_last_stamp_and_the_mean_rate_where_it_is_another(folder):
    samples.recording(folder)
    out, _ = done_with(0, "info", folder / "imu.csv")
    assert "           from 0 to 99999999 ns\n" in out and "on the whole" not in out, out
    out, _ = done_with(0, "info", folder / "mocap.bvh")
    assert "clip (bvh)" in out and " ns, counted at that rate\n" in out, out
    out, _ = done_with(0, "check", folder / "recording.toml")
    assert out == "3 files read, nothing found\n", out
    (folder / "kinect.csv").write_text(samples.kinect(40))
    rows_dropped(folder / "kinect.csv", range(10, 30))
    out, _ = done_with(0, "info", folder / "kinect.csv")
    assert "at 30 Hz (14.62 over the whole stream); 25 joints" in out, out
    (folder / "imus.sto").write_text(samples.sto())
    out, _ = done_with(0, "info", folder / "imus.sto")
    assert "  stream   imu (sto): 2 samples" in out and "           torso_imu, pelvis_imu\n" in out, out


@case
def streams_that_miss_each_other_are_answered_with_the_start_that_joins_them(folder):
    manifest = samples.recording(folder)
    start = 1_790_000_000_000_000_000
    (folder / "kinect.csv").write_text(samples.kinect(4, start))
    begin = ("align", "--mocap", folder / "mocap.bvh", "--kinect", folder / "kinect.csv", "-o", folder / "t.h5")
    _, err = done_with(3, *begin)
    assert f"  --start-ns {start} moves the first frame of mocap to the start of the others: correct only if all started at the same time\n" in err, err
    done_with(0, *begin, "--start-ns", start, "--space", "none")
    (folder / "imu.csv").write_text(samples.imu(4, start))
    manifest.write_text(samples.manifest().replace("start_ns = 0", "start_ns = 5\nclick_latency_ms = 1"))
    _, err = done_with(3, "align", manifest, "-o", folder / "u.h5")
    assert "imu imu " in err, err
    said = f"start_ns = {start - 1_000_000} in [stream.mocap]"
    assert f"  {said} moves the first frame of mocap to the start of the others: correct only if all started at the same time\n" in err, err
    manifest.write_text(manifest.read_text().replace("start_ns = 5", f"start_ns = {start - 1_000_000}"))
    done_with(0, "align", manifest, "-o", folder / "u.h5")


@case
def the_start_that_joins_points_counts_the_offset_that_moves_them(folder):
    manifest = samples.recording(folder)
    (folder / "later.csv").write_text(samples.kinect(4, 90_000_000_000))
    manifest.write_text('[stream.optical]\nfile = "kinect.csv"\noffset_ms = 5000\n[stream.kinect]\nfile = "later.csv"\n')
    _, err = done_with(3, "align", manifest, "-o", folder / "t.h5")
    said = "start_ns = 85000000000 in [stream.optical]"
    assert f"  {said} moves the first frame of optical to the start of the others: correct only if all started at the same time\n" in err, err
    manifest.write_text(manifest.read_text().replace("offset_ms", "start_ns = 85000000000\noffset_ms"))
    done_with(0, "align", manifest, "-o", folder / "t.h5")


@case
def check_tells_what_align_remarks_of_a_plan(folder):
    manifest = samples.recording(folder)
    (folder / "copy.csv").write_text(samples.imu())
    text = manifest.read_text()
    assert 'file = "imu.csv"' in text
    manifest.write_text(text.replace('file = "imu.csv"', 'files = { waist = "imu.csv", wrist = "copy.csv" }'))
    out, _ = done_with(1, "check", manifest)
    assert "two of its nodes have the same data" in out, out
    out, _ = done_with(1, "align", manifest, "-o", folder / "t.h5")
    assert "two of its nodes have the same data" in out, out


@case
def an_error_in_a_manifest_leads_to_its_page_and_one_in_a_layout_does_not(folder):
    manifest = samples.recording(folder)
    (folder / "own.toml").write_text('name = "own"\nkey = 1\n')
    manifest.write_text(manifest.read_text().replace('file = "imu.csv"', 'file = "imu.csv"\nlayout = "own.toml"'))
    _, err = done_with(3, "align", manifest, "-o", folder / "t.h5")
    assert "own.toml:2: " in err and "recording_toml.md" not in err, err
    manifest.write_text("keys = 1\n")
    _, err = done_with(3, "align", manifest, "-o", folder / "t.h5")
    assert "recording.toml:1: " in err and "recording_toml.md" in err, err


@case
def every_example_of_a_help_page_runs_as_it_stands_beside_a_new_demo(folder):
    demo(folder / "demo", seconds=2)  # what ./dev demo leaves
    done_with(0, "align", folder / "demo/recording.toml", "-o", folder / "demo/take.h5")
    for verb in ("align", "info", "check", "convert", "rebuild", "config"):
        for command in examples(verb):
            # A recording: rehearsal_check.py makes one. A BIDS folder: dataset_export_check.py does. A model:
            # model_check.py does.
            if "takes/" in command or "walks_bids" in command or ".safetensors" in command:
                continue
            done = typed(command, folder)
            assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"


@case
def warnings_are_coloured_by_check_as_by_align(folder):
    (folder / "mocap.bvh").write_text(samples.bvh().replace("Frames: 4", "Frames: 5"))
    done = kinalign("check", folder / "mocap.bvh", "--color", "always")
    assert done.stdout.startswith(b"\x1b[33mwarning \x1b[0m "), done.stdout


if __name__ == "__main__":
    sys.exit(main())
