# SPDX-License-Identifier: Apache-2.0
"""What the flags of a call do: to the numbers of a take, and to the disk.
effects_check.py BUILD_FOLDER [CASE...]"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import h5py
import numpy as np
from scipy.spatial.transform import Rotation

import samples
from cases import WRITES_ITSELF, Skip, case, done_with, main, parsed, wrong

FRAMES = 4
# Joint, parent, offset in centimetres: a standing person of ten joints, hips 90 cm above the soles.
FIGURE = (("Hips", -1, (0, 90, 0)), ("LeftUpLeg", 0, (10, -2, 0)), ("LeftLeg", 1, (0, -43, 1)),
          ("LeftFoot", 2, (0, -45, -2)), ("RightUpLeg", 0, (-10, -2, 0)), ("RightLeg", 4, (0, -43, 1)),
          ("RightFoot", 5, (0, -45, -2)), ("Spine", 0, (0, 20, 3)), ("Neck", 7, (0, 35, 0)), ("Head", 8, (0, 12, 1)))


def angles(joint, frame):
    """Of three turns about z, x and y, degrees: no two joints move alike."""
    return 3.0 * frame + joint, 0.5 * joint - 2.0 * frame, 4.0 * frame - 0.25 * joint


def place(frame):
    return 5.0 + frame, 90.0 + 0.5 * frame, 120.0 - 3.0 * frame


def figure(up="y", scale=1.0):
    """The same motion written y up or z up, where (x, y, z) stands as (x, -z, y)."""
    def axes(v):
        x, y, z = (scale * c for c in v)
        return (x, -z, y) if up == "z" else (x, y, z)

    def joint(index, indent):
        name, parent, offset = FIGURE[index]
        children = [i for i, one in enumerate(FIGURE) if one[1] == index]
        turns = "Zrotation Xrotation Yrotation" if up == "y" else "Yrotation Xrotation Zrotation"
        channels = f"3 {turns}" if index else f"6 Xposition Yposition Zposition {turns}"
        inner = "".join(joint(i, indent + "  ") for i in children)
        end = "" if children else f"{indent}  End Site\n{indent}  {{\n{indent}    OFFSET 0 0 0\n{indent}  }}\n"
        return (f"{indent}{'ROOT' if parent < 0 else 'JOINT'} {name}\n{indent}{{\n{indent}  OFFSET "
                f"{' '.join(map(repr, axes(offset)))}\n{indent}  CHANNELS {channels}\n{inner}{end}{indent}}}\n")

    rows = ""
    for k in range(FRAMES):
        numbers = list(axes(place(k)))
        for j in range(len(FIGURE)):
            a, b, c = angles(j, k)
            numbers += (a, b, c) if up == "y" else (-a, b, c)
        rows += " ".join(map(repr, numbers)) + "\n"
    return f"HIERARCHY\n{joint(0, '')}MOTION\nFrames: {FRAMES}\nFrame Time: 0.0333333\n{rows}"


def truth():
    """Positions [T,J,3] in metres, y up, by SciPy's rotations."""
    out = np.zeros((FRAMES, len(FIGURE), 3))
    for k in range(FRAMES):
        turned = []
        for j, (_, parent, offset) in enumerate(FIGURE):
            own = Rotation.from_euler("ZXY", angles(j, k), degrees=True)
            turned.append(turned[parent] * own if j else own)
            out[k, j] = out[k, parent] + turned[parent].apply(offset) if j else np.array(place(k))
    return 0.01 * out


def arrays(path):
    """All numbers of a take's mocap, and the Kinect's positions where there are any."""
    with h5py.File(path) as take:
        found = {name: take["mocap"][name][:] for name in ("positions", "local_positions", "local_rotations",
                                                           "rest_offsets")}
        if "kinect" in take:
            found["kinect"] = take["kinect/positions"][:]
        return found


def aligned(folder, mocap, *flags, code=0):
    """By flags; the same by a manifest's keys gives the same numbers."""
    common = ("--double", "--force")
    done_with(code, "align", "--mocap", folder / mocap, "--start-ns", "0", "--kinect", folder / "kinect.csv", "--space",
              "none", *flags, "-o", folder / "flags.h5", *common)
    keys = "".join(f"{flag[2:].replace('-', '_')} = {value if flag != '--up' else repr(value)}\n"
                   for flag, value in zip(flags[::2], flags[1::2]))
    (folder / "keys.toml").write_text(f'[stream.mocap]\nfile = "{mocap}"\nstart_ns = 0\n{keys}'
                                      '[stream.kinect]\nfile = "kinect.csv"\n')
    done_with(code, "align", folder / "keys.toml", "-o", folder / "keys.h5", *common)
    found, by_keys = arrays(folder / "flags.h5"), arrays(folder / "keys.h5")
    assert found.keys() == by_keys.keys()
    for name, values in found.items():
        assert (values == by_keys[name]).all(), f"{name} differ between {flags} and the manifest"
    return found


def figures(folder):
    samples.recording(folder)
    for name, text in (("y.bvh", figure()), ("z.bvh", figure(up="z")), ("metres.bvh", figure(scale=0.01))):
        (folder / name).write_text(text)


@case
def a_mocap_file_that_is_z_up_gives_the_take_of_its_y_up_twin(folder):
    figures(folder)
    upright, turned = aligned(folder, "y.bvh"), aligned(folder, "z.bvh", "--up", "z")
    for found in (upright, turned):
        assert np.abs(found["positions"] - truth()).max() <= 1e-12, found["positions"] - truth()
    # Without the flag, the person lies: the file's own numbers are taken for y up.
    lying = aligned(folder, "z.bvh", code=1)["positions"]
    x, y, z = np.moveaxis(truth(), -1, 0)
    assert np.abs(lying - np.stack((x, -z, y), -1)).max() <= 1e-12
    assert (turned["kinect"] == upright["kinect"]).all(), "--up is the mocap file's alone"


@case
def the_unit_of_a_mocap_file_scales_its_lengths_and_nothing_else(folder):
    figures(folder)
    centimetres, metres = aligned(folder, "y.bvh"), aligned(folder, "metres.bvh", "--metres-per-unit", "1")
    double = aligned(folder, "y.bvh", "--metres-per-unit", "0.02", code=1)  # hips at 1.8 m
    for name in ("positions", "local_positions", "rest_offsets"):
        assert np.abs(metres[name] - centimetres[name]).max() <= 1e-12, name
        assert (double[name] == 2 * centimetres[name]).all(), name
    for found in (metres, double):
        assert (found["local_rotations"] == centimetres["local_rotations"]).all()
        assert (found["kinect"] == centimetres["kinect"]).all(), "the unit is the mocap file's alone"


@case
def info_and_check_find_a_person_upright_only_with_the_files_own_axis(folder):
    figures(folder)
    for name, up, findings in (("y.bvh", "y", 0), ("z.bvh", "z", 0), ("y.bvh", "z", 1), ("z.bvh", "y", 1)):
        said = parsed(done_with(0, "info", folder / name, "--up", up, "--json")[0])
        found = said["streams"][0]["findings"]
        assert len(found) == findings, f"{name} --up {up}: {found}"
        out, _ = done_with(findings, "check", folder / name, "--up", up)
        assert ("the person appears to lie" in out) == (findings == 1), out
        assert findings == 0 or f"--up {name[0]} " in out, out


def disk(folder):
    """Everything below a folder: bytes, and what would show that a file was written again or replaced."""
    found = {}
    for path in sorted(folder.rglob("*")):
        status = path.lstat()
        found[path] = (status.st_mtime_ns, status.st_ino, path.read_bytes() if path.is_file() else b"")
    return found


@case
def a_dry_run_says_what_would_be_done_and_writes_nothing(folder):
    if WRITES_ITSELF:
        raise Skip("a sanitizer's own file")
    manifest, temporary = samples.recording(folder), folder / "temporary"
    temporary.mkdir()
    done_with(0, "align", manifest, "-o", folder / "old.h5")
    quick = ("--mocap", folder / "mocap.bvh", "--start-ns", "0", "--kinect", folder / "kinect.csv", "--space", "none")
    for recording in ((manifest,), quick):
        said = parsed(done_with(0, "align", *recording, "-o", folder / "new.h5", "--json")[0])
        (folder / "new.h5").unlink()
        before = disk(folder)
        for out in ((), ("-o", folder / "new.h5"), ("-o", folder / "old.h5"), ("-o", folder / "old.h5", "--force"),
                    ("-o", folder / "absent/new.h5"), ("-o", folder / "mocap.bvh", "--force")):
            words = ("align", *recording, *out, "--dry-run")
            dry, _ = done_with(0, *words, cwd=folder, env={"TMPDIR": str(temporary)})
            assert dry.startswith("nothing written: "), dry
            assert parsed(done_with(0, *words, "--json", cwd=folder)[0]) == said, f"{words}: another report"
            assert disk(folder) == before, f"{words} wrote {disk(folder).keys() ^ before.keys()}"


@case
def only_align_has_a_dry_run(folder):
    verbs = re.findall(r"^  (\w+)  +\w", done_with(0, "help")[0].split("\nverbs\n")[1], re.M)
    assert "align" in verbs and len(verbs) > 5, verbs
    have = [verb for verb in verbs if "--dry-run" in done_with(0, verb, "--help")[0]]
    assert have == ["align"], f"{have}: show in the case above that it writes nothing"
    samples.recording(folder)
    for words in (("convert", folder / "mocap.bvh", folder / "o.npz"), ("info", folder / "mocap.bvh")):
        wrong(*words, "--dry-run", says="expected a known flag, found --dry-run")
    assert not (folder / "o.npz").exists()


@case
def a_name_that_no_file_has_is_answered_with_where_the_names_stand(folder):
    manifest = samples.recording(folder)
    good = manifest.read_text()
    line = "kinalign info FILE -v lists the names of joints and nodes"
    for old, new, advised in ((samples.manifest()[-8:], '"fit"\njoints = { SpineBase = "Hps" }\n', True),
                              (samples.manifest()[-8:], '"fit"\njoints = { SpineBse = "Hips" }\n', True),
                              (samples.manifest()[-8:], '"paper"\nroot = "SpineBse"\n', True),
                              (samples.manifest()[-8:], '"paper"\nonto_root = "Hps"\n', True),
                              ('"imu.csv"\n', '"imu.csv"\nroot_node = "waste"\n', True),
                              ('"imu.csv"\n', '"imu.csv"\nmounting = { waste = [1, 0, 0, 0] }\n', True),
                              ("start_ns = 0", "start_ns = 9000000000", False)):
        assert old in good
        manifest.write_text(good.replace(old, new))
        _, err = done_with(3, "align", manifest, "-o", folder / "t.h5")
        assert (f"\n  {line}\n" in err) == advised, err
        out, _ = done_with(1, "check", manifest)
        assert (f" {line}\n" in out) == advised, out
    _, err = done_with(3, "align", "--mocap", folder / "mocap.bvh", "--start-ns", "0", "--kinect",
                       folder / "kinect.csv", "--joint", "SpineBase=Hps", "-o", folder / "t.h5")
    assert f"\n  {line}\n" in err, err


if __name__ == "__main__":
    sys.exit(main())
