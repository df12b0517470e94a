# SPDX-License-Identifier: Apache-2.0
"""Published corpora become takes of a data set. dataset_import_check.py BUILD_FOLDER [CASE...]"""
import importlib.util
import pathlib
import re
import shutil
import sys

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import Skip, case, kinalign, main
from data_sets import SHARED, answer, contents, done, shared, small_bvh, takes


@case
def a_folder_per_person_becomes_a_data_set_that_builds(folder):
    source = small_bvh(folder, "anna/walk_02.bvh", "anna/walk_03.bvh", "bert/run.bvh", "01_07.bvh", "x/05_01.bvh")
    (source / "01_07.bvh").rename(source / "anna/01_07.bvh")
    made = answer("import", folder / "set", source)
    assert (made["corpus"], made["takes"], made["added"], made["new_data_set"]) == ("bvh", 5, 5, True), made
    assert takes(folder / "set") == ["sub-01_task-motion_run-07", "sub-05_task-motion_run-01", "sub-anna_task-walk_run-02",
                                     "sub-anna_task-walk_run-03", "sub-bert_task-run_run-01"]
    assert answer("build", folder / "set")["made"] == 5
    assert "no faults" in done("verify", folder / "set", "--deep")


@case
def the_same_import_said_again_adds_nothing_also_with_copies(folder):
    source = small_bvh(folder, "anna/walk.bvh", "bert/walk.bvh", "bert/walk_2.bvh")
    for copy in ([], ["--copy"]):
        data = folder / f"set{len(copy)}"
        assert answer("import", data, source, *copy)["added"] == 3
        before = contents(data)
        again = answer("import", data, source, *copy)
        assert (again["added"], again["were_there"]) == (0, 3), again
        assert contents(data) == before
        assert any("sourcedata" in name for name in before) == bool(copy)
    shutil.rmtree(source)
    assert answer("build", folder / "set1")["made"] == 3


@case
def what_a_user_wrote_into_dataset_toml_stays_as_it_is(folder):
    source = small_bvh(folder, "anna/walk.bvh")
    done("init", folder / "set", "--name", "mine")
    own = (folder / "set/dataset.toml").read_text() + "\n[subject.anna] # no consent yet\nsex = \"f\"\n"
    (folder / "set/dataset.toml").write_text(own)
    done("import", folder / "set", source)
    text = (folder / "set/dataset.toml").read_text()
    assert text.startswith(own) and text.count("[subject.anna]") == 1 and "[action.walk]" in text, text
    (folder / "set/dataset.toml").write_text("subject = { bert = { } }\n")
    before = contents(folder / "set")
    assert "a file to which [subject.ID]" in done("import", folder / "set", source, code=3)
    assert contents(folder / "set") == before


@case
def a_new_data_set_gets_the_terms_of_the_corpus_and_one_with_people_keeps_its_own(folder):
    packed = SHARED / "cmu"
    if not packed.exists():
        raise Skip("no shared/data")
    done("init", folder / "new")
    done("import", folder / "new", packed)
    terms = (folder / "new/dataset.toml").read_text()
    assert 'licence = "free for all uses' in terms and "NSF EIA-0196217" in terms, terms[:600]
    done("init", folder / "own", "--template", "hfut-mmd")
    done("import", folder / "own", packed)
    assert 'licence = ""' in (folder / "own/dataset.toml").read_text()


@case
def a_folder_of_motion_in_another_unit_or_with_z_up_says_so_once(folder):
    source = small_bvh(folder, "anna/walk.bvh")
    done("import", folder / "cm", source)
    done("import", folder / "m", source, "--metres-per-unit", "1", "--up", "z")
    heights = {}
    for name in ("cm", "m"):
        ran = kinalign("dataset", "build", folder / name)
        assert ran.returncode in (0, 1), ran
        with h5py.File(next((folder / name).rglob("*_take.h5"))) as file:
            heights[name] = file["mocap/positions"][0]
    x, y, z = heights["cm"].T * 100
    turned = numpy.stack([x, z, -y], axis=1)  # what was called z is up
    assert numpy.allclose(heights["m"], turned, rtol=1e-4, atol=1e-3), (heights["m"][:2], turned[:2])
    manifest = next((folder / "m").rglob("*_recording.toml")).read_text()
    assert "metres_per_unit = 1" in manifest and re.search("up = ['\"]z['\"]", manifest), manifest
    (folder / "s.mvnx").write_text("<mvnx/>")
    for flag, value in (("--metres-per-unit", "1"), ("--up", "z")):
        ran = kinalign("dataset", "import", folder / "other", folder / "s.mvnx", "--subject", "1", flag, value)
        assert ran.returncode == 3 and f"{flag}: expected files of bvh, c3d or trc, found mvnx" in ran.stderr.decode(), ran
        assert not (folder / "other").exists()


@case
def words_that_are_no_ids_become_such_and_stay_apart(folder):
    source = small_bvh(folder, "p1/slow walk.bvh", "p1/slow_walk.bvh", "p1/größe.bvh", "p2/slow walk.bvh")
    made = answer("import", folder / "set", source)
    ids = made["action_ids"]
    assert ids["slow walk"] == "slowWalk" and ids["slow_walk"] == "slowWalkx2" and ids["größe"] == "grE", ids
    assert answer("import", folder / "set", source)["added"] == 0
    text = (folder / "set/dataset.toml").read_text()
    assert '[action.slowWalkx2]\nclass = "motion"\nname = "slow_walk"' in text, text


@case
def files_that_say_nobody_need_a_subject(folder):
    source = small_bvh(folder, "walk.bvh", "down_1Char00.bvh")
    err = done("import", folder / "set", source, code=3)
    assert "--subject" in err and not (folder / "set").exists(), err
    assert answer("import", folder / "set", source, "--subject", "07")["added"] == 2
    assert takes(folder / "set") == ["sub-07_task-down_run-01", "sub-07_task-walk_run-01"]
    done("import", folder / "two", source / "walk.bvh", "--subject", "07", "--action", "jump")
    assert takes(folder / "two") == ["sub-07_task-jump_run-01"]


@case
def an_unknown_corpus_is_an_error_that_lists_the_known_ones(folder):
    (folder / "source").mkdir()
    (folder / "source/notes.txt").write_text("nothing")
    err = done("import", folder / "set", folder / "source", code=3)
    for kind in ("ui-prmd", "ui-prmd-joints", "cmu", "keraal", "kinectmultitrack", "ntu", "bids", "bvh", "c3d", "mvnx", "trc"):
        assert f"{kind} (" in err, err
    assert not (folder / "set").exists()
    done("import", folder / "set", folder / "source", "--from", "nothing", code=2)
    small_bvh(folder, "anna/walk.bvh", "anna/walk.trc")
    assert "--from" in done("import", folder / "set", folder / "source", code=3)


def skeleton(bodies):
    """Frames of an NTU file; `bodies`: the ids in each."""
    lines = [str(len(bodies))]
    for ids in bodies:
        lines.append(str(len(ids)))
        for one in ids:
            lines += [f"{one} 0 1 1 1 1 0 0.1 0.2 2", "25"]
            lines += [f"0.{k:02} {k / 10} 3 1 2 3 4 1 0 0 0 2" for k in range(25)]
    return "\n".join(lines) + "\n"


@case
def names_of_ntu_say_person_action_and_run_and_mutual_actions_have_two_streams(folder):
    source = folder / "source"
    source.mkdir()
    (source / "S017C001P008R002A050.skeleton").write_text(skeleton([["1", "2"]] * 5 + [["2"]]))
    (source / "S017C003P008R002A001.skeleton").write_text(skeleton([["1", "2"]] * 5 + [["2"]]))
    (source / "S017C003P008R002A002.skeleton").write_text(skeleton([[], []]))
    made = answer("import", folder / "set", source)
    assert made["left_out"] == [{"what": "S017C003P008R002A002", "why": "without a skeleton"}], made
    assert takes(folder / "set") == ["sub-008_task-A001_run-1732", "sub-008_task-A050_run-1712"]
    text = (folder / "set/sub-008/sub-008_task-A050_run-1712_recording.toml").read_text()
    assert text.index('body = "2"') < text.index("[stream.partner]") < text.index('body = "1"'), text
    assert answer("build", folder / "set")["made"] == 2
    (source / "S017C003P008R002A003.skeleton").write_text("1\nmany\n")
    assert "A003.skeleton:2: expected the number of bodies, found many" in done("import", folder / "set", source, code=3)


def places(text):
    """Joint places of a BVH, metres: an independent reader."""
    names, parents, offsets, channels, open_joints = [], [], [], [], []
    lines = iter(text.splitlines())
    for line in lines:
        words = line.split()
        if words[0] in ("ROOT", "JOINT"):
            parents.append(open_joints[-1] if open_joints else -1)
            names.append(words[1])
            now = len(names) - 1
        elif words[0] == "End":
            now = None
        elif words[0] == "{":
            open_joints.append(now)
        elif words[0] == "}":
            open_joints.pop()
        elif words[0] == "OFFSET" and open_joints[-1] is not None:
            offsets.append([float(w) for w in words[1:]])
        elif words[0] == "CHANNELS":
            channels.append(words[2:])
        elif words[0] == "MOTION":
            break
    next(lines), next(lines)
    rows = numpy.array([[float(w) for w in line.split()] for line in lines])
    at, turned, column = [], [], 0
    for j, parent in enumerate(parents):
        place = numpy.tile(offsets[j], (len(rows), 1))
        turn = numpy.tile(numpy.eye(3), (len(rows), 1, 1))
        for channel in channels[j]:
            axis, value, column = "XYZ".index(channel[0]), rows[:, column], column + 1
            if channel.endswith("position"):
                place[:, axis] = value
                continue
            a, b = (axis + 1) % 3, (axis + 2) % 3
            one = numpy.tile(numpy.eye(3), (len(rows), 1, 1))
            one[:, a, a] = one[:, b, b] = numpy.cos(numpy.radians(value))
            one[:, b, a] = numpy.sin(numpy.radians(value))
            one[:, a, b] = -one[:, b, a]
            turn = turn @ one
        if parent < 0:
            at.append(place)
            turned.append(turn)
        else:
            at.append(at[parent] + numpy.einsum("tab,tb->ta", turned[parent], place))
            turned.append(turned[parent] @ turn)
    return names, numpy.stack(at, 1) / 100


@case
def cmus_clips_come_in_by_one_command_and_stand_where_its_reference_puts_them(folder):
    source = shared("cmu")
    made = answer("import", folder / "set", source, seconds=300)
    assert (made["corpus"], made["takes"], made["subjects"], len(made["left_out"])) == ("cmu", 353, 30, 28), made
    sys.path.insert(0, str(source))
    import unpack_cmu
    worst, compared = 0.0, 0
    for i, clip in enumerate(unpack_cmu.clips()):
        if i % 16:
            continue
        bvh, = (folder / "set/sourcedata").glob(f"{clip['file'][:-4].replace('_', '')}-*/{clip['person']}__{clip['take']}.bvh")
        names, found = places(bvh.read_text())
        at, turned = [], []
        for j, parent in enumerate(clip["parents"]):
            if parent < 0:
                at.append(clip["pos"] + clip["rest"][j])
                turned.append(clip["rot"][:, j])
            else:
                at.append(at[parent] + turned[parent] @ clip["rest"][j])
                turned.append(turned[parent] @ clip["rot"][:, j])
        found = found[:, [names.index(joint) for joint in clip["joints"]]]
        worst = max(worst, numpy.linalg.norm(found - numpy.stack(at, 1), axis=-1).max())
        compared += 1
    assert compared == 24 and worst < 1e-6, (compared, worst)  # six decimals of a centimetre and of a degree
    assert answer("build", folder / "set", seconds=600)["made"] == 353
    assert answer("build", folder / "set", seconds=600)["up_to_date"] == 353


@case
def ui_prmd_comes_in_by_one_command_and_equals_its_source(folder):
    source = shared("ui_prmd")
    made = answer("import", folder / "set", source, seconds=300)
    assert (made["corpus"], made["takes"], made["subjects"], made["actions"]) == ("ui-prmd", 690, 7, 10), made
    assert {one["why"] for one in made["left_out"]} == {"without Vicon"} and len(made["left_out"]) == 10, made
    assert answer("import", folder / "set", source, seconds=300)["added"] == 0
    for device, kind, half_a_step, rows in (("Kinect", "Positions", 0.005, 1), ("Kinect", "Angles", 0.005, 1),
                                            ("Vicon", "Positions", 0.05, 2)):
        name = f"{device}/{kind}/m10_s05_e02_{kind.lower()}.txt"
        unpacked, = (folder / "set/sourcedata").glob(f"s05-*/{name}")
        was = numpy.loadtxt(source / "original" / name, delimiter=",")[::rows]
        now = numpy.loadtxt(unpacked, delimiter=",")
        assert was.shape == now.shape and abs(was - now).max() < half_a_step + 1e-9, name
    assert answer("build", folder / "set", seconds=600)["made"] == 690
    assert answer("build", folder / "set", seconds=600)["up_to_date"] == 690
    assert "no faults" in done("verify", folder / "set", seconds=300)


def protocol():
    """The script that defines UI-PRMD's pairs."""
    if not (SHARED.parent / "tools/ui_prmd_marks.py").exists() or not importlib.util.find_spec("scipy"):
        raise Skip("needs ../shared/tools/ui_prmd_marks.py and SciPy")
    sys.path.insert(0, str(SHARED.parent / "tools"))
    import ui_prmd_marks
    return ui_prmd_marks


@case
def ui_prmds_pairs_are_those_of_its_protocol(folder):
    source, marks = shared("ui_prmd"), protocol()
    made = answer("import", folder / "set", source / "s01.npz", "--from", "ui-prmd-joints", seconds=300)
    left_out = dict(re.fullmatch(r"(m.._s.._e..) \((.*) cm\)", one["what"]).groups() for one in made["left_out"])
    assert (made["corpus"], made["takes"], len(left_out)) == ("ui-prmd-joints", 73, 27), made
    assert answer("import", folder / "set", source / "s01.npz", "--from", "ui-prmd-joints", seconds=300)["added"] == 0
    assert answer("build", folder / "set", seconds=300)["made"] == made["takes"]
    some = [one for one in marks.load(str(source), [1]) if one["movement"] in (1, 2, 3)]
    kept = {(one["movement"], one["repetition"]): one for one in marks.align(some)}
    turned = numpy.array([-1, 1, -1])  # from the packs' space to the reader's: half a turn about y
    for one in some:
        name, key = f"m{one['movement']:02}_s01_e{one['repetition']:02}", (one["movement"], one["repetition"])
        assert (name in left_out) == (key not in kept), name
        if name in left_out:
            assert abs(float(left_out[name]) - one["rms"]) <= 0.0501, (name, left_out[name], one["rms"])
            continue
        stem = folder / f"set/sub-01/sub-01_task-m{key[0]:02}_run-{key[1]:02}"
        offset = re.search(r"offset_ms = (\S+)", stem.with_name(stem.name + "_recording.toml").read_text())
        assert abs(float(offset[1]) + 1000 * one["tau"]) < 1e-6, (name, offset[1], one["tau"])
        with h5py.File(stem.with_name(stem.name + "_take.h5")) as take:
            truth, valid = take["mocap/positions"][:], take["mocap/valid"][:] == 1
        wanted = kept[key]
        frames = min(len(truth), len(wanted["y"]))  # a last frame at the very end is there by rounding
        assert abs(len(truth) - len(wanted["y"])) <= 1 and (valid[:frames] == wanted["w"][:frames]).all(), name
        apart = numpy.linalg.norm(truth[:frames] - wanted["y"][:frames] * turned / 100, axis=-1)[valid[:frames]]
        assert apart.max() < 0.001, (name, apart.max())  # beside gaps our spline ends, the script's runs on


@case
def ui_prmds_pairs_come_only_when_asked_for_and_become_windows(folder):
    source = shared("ui_prmd") / "s02.npz"
    assert answer("import", folder / "plain", source, seconds=300)["corpus"] == "ui-prmd"
    made = answer("import", folder / "set", source, "--from", "ui-prmd-joints", "--jobs", "1", seconds=300)
    again = answer("import", folder / "two", source, "--from", "ui-prmd-joints", "--jobs", "4", seconds=300)
    assert made == again and contents(folder / "set") == contents(folder / "two")
    assert answer("build", folder / "set", seconds=300)["made"] == made["takes"]
    done("windows", folder / "set", "-o", folder / "w.npz", "--length", "32", "--step", "32")
    windows = numpy.load(folder / "w.npz")
    assert windows["mocap_positions"].shape[1:] == (32, 3 * 18) and windows["kinect_positions"].shape[1:] == (32, 3 * 22)


@case
def a_pair_of_files_of_one_name_is_copied_apart_and_rebuilt(folder):
    source = shared("ui_prmd") / "original"
    for copy in ([], ["--copy"]):
        data = folder / f"set{len(copy)}"
        assert answer("import", data, source, *copy)["added"] == 2
        assert answer("import", data, source, *copy)["added"] == 0
        assert answer("build", data)["made"] == 2
        assert answer("build", data)["up_to_date"] == 2
        assert "no faults" in done("verify", data, "--deep")
    assert len(list((folder / "set1/sourcedata").rglob("*.txt"))) == 6
    take = folder / "set0/sub-05/sub-05_task-m10_run-02_take.h5"
    ran = kinalign("rebuild", take, "--inputs", source, "--verify")
    assert ran.returncode == 0, ran


@case
def two_devices_of_a_file_or_of_a_pair_come_as_two_streams(folder):
    for name, count, subject in (("kinect_keraal", 2, "G3P1"), ("kinect_multitrack", 3, "10")):
        made = answer("import", folder / name, shared(name))
        assert made["takes"] == count, made
        assert answer("build", folder / name)["made"] == count
        streams = done("query", folder / name, "select take, count(*) from streams group by take", "--format", "csv")
        assert streams.count(f"sub-{subject}") == count and streams.count(",2") >= count, streams


@case
def tracking_systems_of_bids_motion_become_streams(folder):
    source = shared("bids_motion")
    made = answer("import", folder / "set", source)
    assert (made["corpus"], made["takes"]) == ("bids", 1), made
    manifest, = (folder / "set").glob("sub-07/sub-07_task-dualWalking_run-01_recording.toml")
    assert "[stream.PhaseSpace1]" in manifest.read_text() and "[stream.PhaseSpace2]" in manifest.read_text()


if __name__ == "__main__":
    sys.exit(main())
