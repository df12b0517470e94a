# SPDX-License-Identifier: Apache-2.0
"""Files of any content, places of any kind: the program ends by itself, says one clear line and
leaves nothing behind (see law in cases.py). bad_input_check.py BUILD_FOLDER [CASE...]"""
import ctypes
import json
import os
import pathlib
import random
import re
import struct
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
import samples
from cases import LONG, WRITES_ITSELF, Skip, case, demo, done_with, kinalign, law, main, nobody, refused

RUBBISH = bytes(random.Random(5).randrange(256) for _ in range(5000))


def try_stream(path):
    words = ("check", path, "--json")
    return law(kinalign(*words), words)


def damaged(text, seed, count):
    """Copies of a file: cut, with a bit turned, with a piece doubled, with rubbish put in."""
    draw = random.Random(seed)
    for k in range(count):
        bytes_ = bytearray(text)
        at = draw.randrange(len(bytes_))
        kind = k % 4
        if kind == 0:
            del bytes_[at:]
        elif kind == 1:
            for _ in range(1 + k % 3):
                bytes_[draw.randrange(len(bytes_))] ^= 1 << draw.randrange(8)
        elif kind == 2:
            bytes_[at:at] = bytes_[at:at + draw.randrange(1, 60)]
        else:
            bytes_[at:at + 3] = RUBBISH[k:k + draw.randrange(9)]
        yield bytes(bytes_)


@case
def the_samples_themselves_are_read(folder):
    for name, make in samples.STREAMS.items():
        (folder / name).write_text(make())
        done = kinalign("check", folder / name)
        assert done.returncode in (0, 1), f"{name}: {done.stderr.decode()}"
    samples.recording(folder / "r")
    done = kinalign("align", folder / "r/recording.toml", "-o", folder / "t.h5")
    assert done.returncode == 0, done.stderr


@case
def a_damaged_stream_is_read_or_refused(folder):
    for name, make in samples.STREAMS.items():
        for bytes_ in damaged(make().encode(), name, 400 if LONG else 24):
            (folder / name).write_bytes(bytes_)
            try_stream(folder / name)


@case
def a_damaged_manifest_or_layout_is_read_or_refused(folder):
    manifest = samples.recording(folder)
    (folder / "table.csv").write_text(samples.laid_out())
    for bytes_ in damaged(samples.manifest().encode(), 1, 800 if LONG else 40):
        manifest.write_bytes(bytes_)
        words = ("align", manifest, "-o", folder / "t.h5")
        law(kinalign(*words), words)
        (folder / "t.h5").unlink(missing_ok=True)
    for bytes_ in damaged(samples.layout().encode(), 2, 800 if LONG else 40):
        (folder / "mine.toml").write_bytes(bytes_)
        words = ("check", folder / "table.csv", "--layout", folder / "mine.toml", "--json")
        law(kinalign(*words), words)


@case
def a_damaged_take_is_read_or_refused(folder):
    manifest = samples.recording(folder)
    take = folder / "t.h5"
    assert kinalign("align", manifest, "-o", take).returncode == 0
    whole = take.read_bytes()
    for k, bytes_ in enumerate(damaged(whole, 3, 1200 if LONG else 60)):
        take.write_bytes(bytes_)
        words = (("info", take, "--json"), ("check", take, "--json"),
                 ("convert", take, folder / "t.npz"),
                 ("rebuild", take, "--inputs", folder, "--verify", "--json"))[k % 4]
        law(kinalign(*words), words, folder / "t.npz" if words[0] == "convert" else None)
        (folder / "t.npz").unlink(missing_ok=True)


@case
def a_take_whose_report_is_no_JSON_is_refused(folder):
    take = folder / "t.h5"
    assert kinalign("align", samples.recording(folder), "-o", take).returncode == 0
    take.write_bytes(take.read_bytes().replace(b'{\n  "schema": "kinalign.report/1"', b'{\n  "schema": [kinalign.report/1"'))
    for words in (("info", take), ("info", take, "--json"), ("check", take)):
        refused(*words, naming=take)


@case
def what_is_no_regular_file_is_refused_at_once(folder):
    os.mkfifo(folder / "pipe")
    (folder / "folder").mkdir()
    for place, kind in ((folder / "pipe", "a pipe"), (folder / "folder", "a directory"),
                        (pathlib.Path("/dev/zero"), "a device"),
                        (folder / "absent", "No such file or directory")):
        for words in (("check", place), ("info", place), ("convert", place, folder / "o.npz"),
                      ("align", place, "-o", folder / "o.h5"),
                      ("align", "--mocap", place, "-o", folder / "o.h5"),
                      ("rebuild", place, "--inputs", folder, "--verify")):
            first = refused(*words, naming=place, out=folder / "o.h5", seconds=20)
            assert kind in first, first
    assert sorted(p.name for p in folder.iterdir()) == ["folder", "pipe"]


@case
def a_file_that_may_not_be_read_is_refused(folder):
    other = nobody()
    folder.chmod(0o755)
    (folder / "walk.bvh").write_text(samples.bvh())
    (folder / "walk.bvh").chmod(0o600)
    first = refused("check", folder / "walk.bvh", naming=folder / "walk.bvh", prefix=other)
    assert "Permission denied" in first, first
    (folder / "walk.bvh").chmod(0o644)
    refused("convert", folder / "walk.bvh", folder / "o.npz", naming=folder / "o.npz", prefix=other,
            out=folder / "o.npz")


@case
def an_empty_file_and_binary_rubbish_are_refused_by_name(folder):
    for name, bytes_ in (("empty.csv", b""), ("rubbish.csv", RUBBISH), ("zeros.csv", bytes(9000)),
                         ("line end.csv", b"\n"), ("mark.csv", b"\xef\xbb\xbf")):
        (folder / name).write_bytes(bytes_)
        for words in (("check", folder / name), ("info", folder / name),
                      ("convert", folder / name, folder / "o.npz")):
            refused(*words, naming=folder / name, out=folder / "o.npz")


@case
def an_empty_recording_is_called_so_by_every_verb(folder):
    path = folder / "empty.mcap"
    path.write_bytes(b"")
    for words in (("check", path), ("info", path), ("convert", path, folder / "o.mcap"),
                  ("recover", path, "-o", folder / "o.mcap"), ("align", path, "-o", folder / "o.h5")):
        first = refused(*words, naming=path)
        assert first == f"kinalign {words[0]}: {path}: expected a recording's file, found an empty file", first
    assert list(folder.iterdir()) == [path]


@case
def what_is_named_as_a_recording_and_is_none_is_called_what_it_is(folder):
    path = folder / "fake.mcap"
    path.write_text(samples.bvh())
    first = refused("align", path, "-o", folder / "o.h5", naming=f"{path}: expected an MCAP file, as its name says")
    assert first.endswith("found 'HIERARCHY'"), first
    refused("recover", path, "-o", folder / "o.mcap", naming=f"{path}: expected an MCAP file, found 'HIERARCHY'")
    out, _ = done_with(0, "check", path)
    assert out.startswith(f"note     {path}: expected the kind of file that its extension says, found bvh: clip, 2 joints"), out


@case
def a_recording_of_which_no_message_can_be_read_becomes_nothing(folder):
    path = folder / "t/torn.mcap"
    path.parent.mkdir()
    path.write_bytes(b"\x89MCAP0\r\n\x01\x15\0\0\0\0\0\0\0" + b"\x08\0\0\0kinalign")
    refused("recover", path, "-o", folder / "o.mcap",
            naming=f"{path}: expected a recording with at least one readable message, found none")
    for words in (("align", path, "-o", folder / "o.h5"), ("convert", path, folder / "o.mcap")):
        refused(*words, naming=f"{path}: expected a recording in which a message can be read, found none")
    assert list(folder.iterdir()) == [path.parent]


@case
def recover_says_first_how_much_of_a_damaged_file_is_lost(folder):
    demo(folder / "d", seconds=20)
    shown, whole = folder / "shown.mcap", folder / "whole.mcap"
    done_with(0, "convert", folder / "d/mocap.bvh", shown)
    done_with(0, "recover", shown, "-o", whole)
    bytes_ = bytearray(shown.read_bytes())
    bytes_[len(bytes_) // 2] ^= 1
    shown.write_bytes(bytes_)
    lines = done_with(1, "recover", shown, "-o", whole, "--force")[0].splitlines()
    assert re.match(rf"{whole}: [\d,]+ of at least [\d,]+ messages in 2 channels, read back and verified", lines[0]), lines
    assert re.match(r"  [\d,]+ are lost, ", lines[1]) and re.match(r"  damage: [\d,]+ bytes ", lines[2]), lines
    said = json.loads(done_with(1, "recover", shown, "-o", whole, "--force", "--json")[0])
    assert said["missing"] > 0 and said["skipped_bytes"] > 0, said


@case
def a_line_of_3_GB_is_refused_without_reading_it_into_memory(folder):
    for name, make in samples.STREAMS.items():
        head = make().encode()
        path = folder / name
        path.write_bytes(head[:len(head) // 2])
        os.truncate(path, 3 << 30)  # zeros, and no room on the disk
        refused("check", path, naming=path, memory=300 << 20)


@case
def where_memory_does_not_suffice_for_a_chunk_it_is_said(folder):
    zstd = ctypes.CDLL("libzstd.so.1")
    zeros = bytes(250 << 20)
    packed = ctypes.create_string_buffer(1 << 20)
    size = zstd.ZSTD_compress(packed, ctypes.c_size_t(len(packed)), zeros, ctypes.c_size_t(len(zeros)), 1)
    stored = packed.raw[:size]
    head = struct.pack("<QQQII", 0, 0, len(zeros), 0, 4) + b"zstd" + struct.pack("<Q", size)
    path = folder / "small.mcap"
    path.write_bytes(b"\x89MCAP0\r\n" + b"\x01" + struct.pack("<QII", 8, 0, 0) +
                     b"\x06" + struct.pack("<Q", len(head) + size) + head + stored)
    for words in (("check", path), ("recover", path, "-o", folder / "o.mcap")):
        refused(*words, naming="expected enough memory for the files, found no free memory", memory=300 << 20)
    assert list(folder.iterdir()) == [path]


@case
def counts_that_lie_cost_no_memory(folder):
    lies = {"walk.bvh": [("Frames: 4", "Frames: 4000000000"), ("CHANNELS 6", "CHANNELS 4000000000"),
                         ("Frames: 4", "Frames: -1"), ("Frames: 4", "Frames: 1e300")],
            "ntu.skeleton": [("3\n0\n", "4000000000\n0\n"), ("\n25\n", "\n4000000000\n"),
                             ("\n1\n72", "\n4000000000\n72")],
            "walk.trc": [("100\t100\t2\t2\t", "100\t100\t4000000000\t2\t"),
                         ("100\t100\t2\t2\t", "100\t100\t2\t4000000000\t"),
                         ("100\t100\t2\t2\t", "1e-300\t100\t2\t2\t")],
            "imus.sto": [("DataRate=100.000000", "DataRate=1e308")],
            "MT_01_00B421E6.txt": [("100.0Hz", "1e-300Hz"), ("65534\t", "99999999999999999999\t")]}
    for name, changes in lies.items():
        for old, new in changes:
            text = samples.STREAMS[name]()
            assert old in text, (name, old)
            (folder / name).write_text(text.replace(old, new, 1))
            words = ("check", folder / name, "--json")
            law(kinalign(*words, memory=300 << 20), words)


@case
def numbers_that_are_none_are_refused_with_their_line(folder):
    for name, make, old, line in (("walk.bvh", samples.bvh, "-3e-1", 19),
                                  ("kinect.csv", samples.kinect, "1.3,", 2),
                                  ("imu.csv", samples.imu, "9.8", 2),
                                  ("keraal.txt", samples.keraal, "1.0", 1)):
        for word in ("inf", "-Infinity", "1e999", "0x10", "1_0", "٣"):
            (folder / name).write_text(make().replace(old, word + ("," if "," in old else ""), 1))
            layout = ("--layout", "keraal_kinect") if "keraal" in name else ()
            refused("check", folder / name, *layout, naming=f"{folder / name}:{line}: ")


@case
def names_in_files_reach_the_terminal_and_JSON_harmlessly(folder):
    for name in ("<script>alert(1)</script>", "a\tb", "\x1b[31mred", "x" * 5000, "\u202egpj", "a\\\"b'"):
        (folder / "walk.bvh").write_text(samples.bvh().replace("JOINT Spine", f"JOINT {name}"))
        for words in (("info", folder / "walk.bvh"), ("info", folder / "walk.bvh", "--json"),
                      ("check", folder / "walk.bvh"), ("check", folder / "walk.bvh", "--json"),
                      ("align", "--mocap", folder / "walk.bvh", "-o", folder / "o.h5", "--force"),
                      ("info", folder / "o.h5"), ("info", folder / "o.h5", "--json")):
            law(kinalign(*words), words)
    for name in ("a\nb.bvh", "\x1b[31m.bvh", "<script>.bvh", "-o", "ä ö.bvh", b"\xff\xfe.bvh"):
        path = folder / os.fsdecode(name)
        path.write_text(samples.bvh())
        for words in (("check", path), ("info", path, "--json"), ("info", path),
                      ("convert", path, folder / "o.npz", "--force", "--json"),
                      ("align", "--mocap", path, "-o", folder / "o.h5", "--force", "--json"),
                      ("info", folder / "o.h5"), ("info", folder / "o.h5", "--json")):
            law(kinalign(*words), words)
        words = ("align", "--mocap", path, "-o", os.fsdecode(bytes(path)) + ".h5")
        law(kinalign(*words), words)
        path.write_text("rubbish")
        words = ("check", path)
        done = kinalign(*words)
        law(done, words)


@case
def a_joint_name_that_repeats_is_a_finding(folder):
    (folder / "walk.bvh").write_text(samples.bvh().replace("JOINT Spine", "JOINT Hips"))
    done = kinalign("check", folder / "walk.bvh")
    assert done.returncode == 1 and b"Hips" in done.stdout, done.stdout
    text = samples.kinect().replace("Neck_x", "Head_x", 1)
    (folder / "kinect.csv").write_text(text)
    refused("check", folder / "kinect.csv", "--layout", "kinect", naming=f"{folder / 'kinect.csv'}:1: ")


@case
def an_output_that_can_not_be_is_refused_and_nothing_is_left(folder):
    manifest = samples.recording(folder)
    before = {p.name: p.read_bytes() for p in folder.iterdir()}
    (folder / "sub").mkdir()
    for out in (folder / "absent/o.h5", folder / "sub", pathlib.Path("/dev/full"),
                pathlib.Path("/proc/o.h5"), folder / "recording.toml/o.h5"):
        refused("align", manifest, "-o", out, "--force", naming=out)
    (folder / "link.h5").symlink_to(folder / "mocap.bvh")
    refused("align", manifest, "-o", folder / "link.h5", "--force", naming=folder / "link.h5")
    refused("align", manifest, "-o", folder / "mocap.bvh", naming=folder / "mocap.bvh")
    (folder / "sub").rmdir()
    (folder / "link.h5").unlink()
    assert {p.name: p.read_bytes() for p in folder.iterdir()} == before


@case
def an_input_is_never_overwritten_by_what_is_made_from_it(folder):
    manifest = samples.recording(folder)
    before = {p.name: p.read_bytes() for p in folder.iterdir()}
    (folder / "hard.csv").hardlink_to(folder / "imu.csv")
    for out in ("mocap.bvh", "kinect.csv", "recording.toml", "hard.csv"):
        refused("align", manifest, "-o", folder / out, "--force", naming=folder / out)
    (folder / "hard.csv").unlink()
    refused("convert", folder / "mocap.bvh", folder / "./mocap.bvh", "--force",
            naming=folder / "mocap.bvh")
    assert {p.name: p.read_bytes() for p in folder.iterdir()} == before


@case
def a_full_disk_is_said_and_leaves_nothing(folder):
    if WRITES_ITSELF:
        raise Skip("a sanitizer's own file")
    manifest = samples.recording(folder / "r")
    (folder / "o").mkdir()
    for words, out in ((("align", manifest, "-o"), "o/t.h5"),
                       (("convert", folder / "r/mocap.bvh"), "o/t.npz"),
                       (("convert", folder / "r/mocap.bvh"), "o/t.bvh")):
        for room in (0, 1, 100, 300):
            refused(*words, folder / out, naming=folder / out, out=folder / out, file_size=room)
            assert list((folder / "o").iterdir()) == [], "a stray file"


@case
def of_what_is_written_a_full_stdout_takes_nothing_back(folder):
    """FACE: what failed, what was left undone."""
    manifest = samples.recording(folder / "r")
    take, again, npz = (folder / name for name in ("t.h5", "again.h5", "t.npz"))
    for words, out in ((("align", manifest, "-o", take), take),
                       (("rebuild", take, "--inputs", folder / "r", "-o", again), again),
                       (("convert", take, npz), npz)):
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([str(cases.PROGRAM), *map(str, words)], stdout=full, check=False,
                                  stderr=subprocess.PIPE, text=True)
        assert done.returncode == 3, done
        assert done.stderr == (
            f"kinalign {words[0]}: standard output: expected room to write, found No space left on "
            f"device\n  {out} was written completely before this error\n"), done.stderr
        assert out.exists()
    assert take.read_bytes() == again.read_bytes()


@case
def a_small_file_system_that_fills_up_leaves_nothing(folder):
    disk = folder / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "kinalign", disk], check=False,
                      capture_output=True).returncode:
        raise Skip("needs leave to mount a tmpfs")
    try:
        demo(folder / "d", seconds=2)
        refused("align", folder / "d/recording.toml", "-o", disk / "t.h5", naming=disk / "t.h5",
                out=disk / "t.h5")
        refused("convert", folder / "d/mocap.bvh", disk / "t.npz", naming=disk / "t.npz",
                out=disk / "t.npz")
        assert list(disk.iterdir()) == []
    finally:
        subprocess.run(["umount", disk], check=True)


if __name__ == "__main__":
    sys.exit(main())
