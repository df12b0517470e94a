# SPDX-License-Identifier: Apache-2.0
"""What each verb takes and what it refuses: flags, manifests, settings.
flags_check.py BUILD_FOLDER [CASE...]"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import h5py
import numpy as np

import samples
from cases import case, done_with, main, refused, wrong


@case
def a_quick_flag_beside_a_manifest_is_refused_with_the_key_that_says_it(folder):
    manifest = samples.recording(folder)
    begin = ("align", manifest, "-o", folder / "t.h5")
    for flag, value, key in (("--mocap", "a.bvh", "file in [stream.mocap]"),
                             ("--kinect", "k.csv", "file in [stream.kinect]"),
                             ("--imu", "waist=w.csv", "files in [stream.imu]"),
                             ("--points", "a=b.csv", "file in [stream.NAME]"),
                             ("--mocap-layout", "trc", "layout in [stream.mocap]"),
                             ("--kinect-layout", "kinect", "layout in [stream.kinect]"),
                             ("--points-layout", "trc", "layout in [stream.NAME]"),
                             ("--imu-layout", "imu", "layout in [stream.imu]"),
                             ("--root-node", "waist", "root_node in [stream.imu]"),
                             ("--start-ns", "0", "start_ns in [stream.mocap]"),
                             ("--metres-per-unit", "1", "metres_per_unit in [stream.mocap]"),
                             ("--up", "z", "up in [stream.mocap]"),
                             ("--space", "none", "method in [space.kinect]"),
                             ("--rotation-y-deg", "3", "rotation_y_deg in [space.kinect]"),
                             ("--joint", "A=B", "joints in [space.kinect]")):
        _, err = done_with(2, *begin, flag, value)
        assert err.startswith(f"kinalign align: {flag}: expected {key} of "), err
        assert "found this flag with a manifest\n" in err, err
    _, err = done_with(2, "align", folder / "take.mcap", "--mocap", "a.bvh", "-o", folder / "t.h5")
    assert err.startswith("kinalign align: --mocap: expected file in [stream.NAME] of a recording.toml, which can combine recordings and files (NAME: a stream's name, see kinalign info), found take.mcap, a recording, which already has streams\n"), err
    done_with(0, *begin, "--gap-ms", "50", "--rotations", "slerp", "--double", "--reference", "mocap")


@case
def a_flag_without_the_file_it_is_for_is_refused(folder):
    samples.recording(folder)
    begin = ("align", "--mocap", folder / "mocap.bvh", "-o", folder / "t.h5")
    for flag, value in (("--space", "paper"), ("--joint", "A=B"), ("--kinect-layout", "kinect")):
        wrong(*begin, flag, value, says=f"{flag}: expected --kinect, to which this flag applies, found no --kinect")
    for flag, value in (("--imu-layout", "imu"), ("--root-node", "waist")):
        wrong(*begin, flag, value, says=f"{flag}: expected --imu, to which this flag applies, found no --imu")
    wrong(*begin, "--points-layout", "trc", says="--points-layout: expected --points, to which this flag applies, found no --points")
    wrong(*begin, "--kinect", folder / "kinect.csv", "--rotation-y-deg", "3",
          says="--rotation-y-deg: expected --space paper, to which this flag applies, found --space fit")


@case
def layouts_of_the_mocap_and_of_further_points_are_those_that_their_flags_name(folder):
    layout = 'name = "one"\nheader = false\nrate_hz = 10\n[joints]\nnames = ["a"]\nfields = ["x", "y", "z"]\n'
    (folder / "own.toml").write_text("metres_per_unit = 0.5\n" + layout)
    (folder / "rows.csv").write_text("1,2,3\n4,5,6\n")
    (folder / "more.csv").write_text("1,2,3\n4,5,7\n")
    begin = ("align", "--mocap", folder / "rows.csv", "--points", f"more={folder}/more.csv", "-o", folder / "t.h5")
    own = ("--mocap-layout", folder / "own.toml", "--points-layout", folder / "own.toml")
    refused(*begin, naming=f"{folder}/rows.csv:1: expected a format that kinalign knows")
    refused(*begin, *own[:2], naming=f"{folder}/more.csv:1: expected a format that kinalign knows")
    refused(*begin, *own[2:], naming=f"{folder}/rows.csv:1: expected a format that kinalign knows")
    done_with(0, *begin, *own)
    done_with(0, "convert", folder / "t.h5", folder / "t.npz")
    take = np.load(folder / "t.npz")
    for name, last in (("mocap_positions", 3), ("more_positions", 3.5)):
        assert np.array_equal(take[name], np.array([[[0.5, 1, 1.5]], [[2, 2.5, last]]], np.float32)), take[name]


@case
def a_flag_whose_value_is_no_pair_is_wrong_use(folder):
    samples.recording(folder)
    begin = ("align", "--mocap", folder / "mocap.bvh", "-o", folder / "t.h5")
    wrong(*begin, "--imu", "w.csv", says="--imu: expected NODE=FILE, found 'w.csv'")
    wrong(*begin, "--points", "w.csv", says="--points: expected NAME=FILE, found 'w.csv'")
    wrong(*begin, "--kinect", "k.csv", "--joint", "A:B", says="--joint: expected KINECT=MOCAP, found 'A:B'")
    wrong(*begin, "--points", "mocap=w.csv", says="--points: expected a name that no other stream uses, found mocap")


@case
def a_file_of_another_kind_than_its_flag_is_named(folder):
    samples.recording(folder)
    k, i, m = folder / "kinect.csv", folder / "imu.csv", folder / "mocap.bvh"
    for flags, naming in ((("--mocap", m, "--imu", f"waist={k}"),
                           f"{k}: expected a file of nodes for --imu waist, found points, 25 joints"),
                          (("--mocap", m, "--kinect", i),
                           f"{i}: expected points for --kinect, found nodes, 1 node: orientation, "
                           "acceleration with gravity, angular velocity"),
                          (("--mocap", m, "--kinect", m),
                           f"{m}: expected points for --kinect, found clip, 2 joints, 1 end site"),
                          (("--mocap", i),
                           f"{i}: expected a skeleton's file or points for --mocap, found nodes")):
        refused("align", *flags, "-o", folder / "t.h5", naming=naming, out=folder / "t.h5")
    # a warning: both are one stream
    done_with(1, "align", "--mocap", k, "--points", f"second={k}", "--imu", f"waist={i}", "-o", folder / "t.h5")


@case
def a_manifests_stream_may_have_any_name_and_two_kinds_of_one_name_are_told(folder):
    manifest = samples.recording(folder)
    text = '[stream.kinect]\nfile = "mocap.bvh"\nstart_ns = 0\n[stream.imu]\nfile = "kinect.csv"\n'
    manifest.write_text(text)
    done_with(0, "align", manifest, "-o", folder / "t.h5")
    manifest.write_text(text.replace('file = "kinect.csv"', 'files = ["kinect.csv", "imu.csv"]'))
    refused("align", manifest, "-o", folder / "u.h5", naming=f"{manifest}: expected streams with different names, found 'imu' "
            "twice: kinect.csv (points) and imu.csv (nodes)", out=folder / "u.h5")


@case
def settings_say_what_the_manifest_leaves_open(folder):
    manifest = samples.recording(folder)
    (folder / "kinalign.toml").write_text("[align]\ngap_ms = 600\nrotations = \"slerp\"\ndouble = true\n")

    def in_force(*flags, **env):
        done_with(0, "align", manifest, "-o", folder / "t.h5", "--force", *flags, cwd=folder, env=env)
        with h5py.File(folder / "t.h5") as take:
            said = json.loads(take["parameters_json"][()].decode().rstrip("\0"))["align"]
        return said["gap_ms"], said["rotations"], said["double"], said["reference"]

    assert in_force() == (600, "slerp", True, "mocap")
    manifest.write_text(samples.manifest().replace("[align]\n", "[align]\ngap_ms = 70\n"))
    assert in_force() == (70, "slerp", True, "mocap")
    assert in_force(KINALIGN_GAP_MS="80") == (80, "slerp", True, "mocap")
    assert in_force("--gap-ms", "90", KINALIGN_GAP_MS="80") == (90, "slerp", True, "mocap")
    (folder / "kinalign.toml").write_text("[align]\nreference = \"kinect\"\n")
    assert in_force()[3] == "mocap"


@case
def an_unknown_reference_is_wrong_use(folder):
    manifest = samples.recording(folder)
    wrong("align", manifest, "-o", folder / "t.h5", "--reference", "kinekt",
          says="--reference: expected a stream: mocap, kinect or imu, found kinekt")
    begin = ("align", "--mocap", folder / "mocap.bvh", "--kinect", folder / "kinect.csv", "-o", folder / "t.h5")
    wrong(*begin, "--reference", "kinekt", says="--reference: expected a stream: mocap or kinect, found kinekt")
    wrong(*begin, "--reference", "kinect",
          says="--reference: expected --space none as well, because the reference is not moved, found --space fit")
    done_with(0, *begin, "--reference", "kinect", "--space", "none")


@case
def convert_names_what_is_missing_and_refuses_what_it_has_no_use_for(folder):
    samples.recording(folder)
    bvh, take = folder / "mocap.bvh", folder / "t.h5"
    done_with(0, "align", folder / "recording.toml", "-o", take)
    wrong("convert", bvh, says="expected OUT (a new file; its extension .npz, .bvh or .mcap decides the format), found nothing")
    wrong("convert", says="expected IN (a take, a recording, or a stream's file), found nothing")
    wrong("convert", bvh, folder / "o.csv", says=f"{folder}/o.csv: expected a name that ends in .npz, .bvh or .mcap, "
          "found another extension")
    _, err = done_with(2, "convert", take, folder / "o.bvh", "--double")
    assert "--double: expected a new file that ends in .npz, found " in err, err
    done_with(0, "convert", take, folder / "o.npz", "--double")
    assert np.load(folder / "o.npz")["kinect_positions"].dtype == np.float64
    done_with(0, "convert", take, folder / "p.npz")
    assert np.load(folder / "p.npz")["kinect_positions"].dtype == np.float32


@case
def flags_that_a_file_has_no_use_for_are_refused(folder):
    manifest = samples.recording(folder)
    take, bvh = folder / "t.h5", folder / "mocap.bvh"
    done_with(0, "align", manifest, "-o", take)
    for file, flags in ((take, ("--layout", "kinect")), (take, ("--metres-per-unit", "3")),
                        (manifest, ("--up", "z")), (bvh, ("--rate-hz", "5")),
                        (folder / "kinect.csv", ("--end-ns", "5")), (folder / "imu.csv", ("--metres-per-unit", "5"))):
        verbs = [("info", file), ("check", file)]
        if file != manifest:
            verbs.append(("convert", file, folder / "o.npz"))
        for words in verbs:
            _, err = done_with(2, *words, *flags)
            assert err.startswith(f"kinalign {words[0]}: {flags[0]}: expected "), err
            assert not (folder / "o.npz").exists()
    _, err = done_with(2, "info", bvh, "--root-node", "x")
    assert "expected a known flag" in err, err
    said = refused("info", bvh, "--select", "a=b", naming=bvh)
    assert said.endswith(": expected no select for a file of format bvh, found a = b"), said
    wrong("info", bvh, "--select", "a", says="--select: expected COLUMN=VALUE, found 'a'")
    done_with(0, "info", bvh, "--up", "z", "--start-ns", "5")


@case
def a_take_does_not_get_the_ending_of_another_format(folder):
    manifest = samples.recording(folder)
    done_with(0, "align", manifest, "-o", folder / "t.h5")
    for name in ("x.npz", "x.csv", "x.bvh"):
        says = ("-o: expected a name for an HDF5 file, such as take.h5 (kinalign convert makes .npz and .bvh of a take), "
                f"found {name}")
        wrong("align", manifest, "-o", folder / name, says=says)
        wrong("rebuild", folder / "t.h5", "--inputs", folder, "-o", folder / name, says=says)


@case
def slerp_is_short_for_rotations_slerp(folder):
    manifest = samples.recording(folder)
    done_with(0, "align", manifest, "-o", folder / "a.h5", "--slerp")
    done_with(0, "align", manifest, "-o", folder / "b.h5", "--rotations", "slerp")
    assert (folder / "a.h5").read_bytes() == (folder / "b.h5").read_bytes()
    wrong("align", manifest, "-o", folder / "c.h5", "--slerp", "--rotations", "spline",
          says="--slerp: expected --rotations or --slerp, found both")


if __name__ == "__main__":
    sys.exit(main())
