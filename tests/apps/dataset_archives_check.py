# SPDX-License-Identifier: Apache-2.0
"""An archive is imported as its folder is, and a hostile one writes nothing. dataset_archives_check.py BUILD_FOLDER [CASE...]"""
import io
import os
import pathlib
import shutil
import stat
import struct
import subprocess
import sys
import tarfile
import zipfile

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import case, kinalign, law, main
from data_sets import answer, contents, done, shared, small_bvh, takes


def zipped(source, path, compression=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", compression) as out:
        for file in sorted(source.rglob("*")):
            out.write(file, f"corpus/{file.relative_to(source)}")
    return path


def tarred(source, path, mode, form=tarfile.PAX_FORMAT):
    with tarfile.open(path, mode, format=form) as out:
        out.add(source, ".")
    return path


@case
def archives_give_what_their_folder_gives(folder):
    source = small_bvh(folder, "änne/walk.bvh", "bert/run_2.bvh", "bert/" + "long" * 40 + ".bvh")
    done("import", folder / "plain", source)
    archives = [zipped(source, folder / "a.zip"), zipped(source, folder / "stored.zip", zipfile.ZIP_STORED),
                tarred(source, folder / "a.tar", "w"), tarred(source, folder / "a.tar.gz", "w:gz"),
                tarred(source, folder / "a.tgz", "w:gz", tarfile.GNU_FORMAT)]
    for archive in archives:
        data = folder / ("from" + archive.name.replace(".", "_"))
        made = answer("import", data, archive)
        assert takes(data) == takes(folder / "plain"), (archive, takes(data), made)
        unpacked = {p.name: p.read_bytes() for p in (data / "sourcedata").rglob("*.bvh")}
        assert unpacked == {p.name: p.read_bytes() for p in source.rglob("*.bvh")}, archive
        before = contents(data)
        assert answer("import", data, archive)["added"] == 0
        assert contents(data) == before
    assert answer("build", data)["made"] == 3


@case
def unpacked_files_that_rm_removed_come_back_with_the_same_import(folder):
    source = small_bvh(folder, "anna/walk.bvh", "bert/run_2.bvh", "bert/jump.bvh")
    bids = shared("bids_motion")
    archive = zipped(source, folder / "a.zip")
    packed = zipped(bids, folder / "bids.zip")
    for data, corpus in ((folder / "set", archive), (folder / "bids_set", packed)):
        done("import", data, corpus)
        before, all_takes = contents(data), takes(data)
        dates = {p: p.stat().st_mtime_ns for p in (data / "sourcedata").rglob("*.*") if p.is_file()}
        done("rm", data, all_takes[0], "--raw", "--yes")
        assert contents(data) != before
        assert answer("import", data, corpus)["added"] == 1
        assert contents(data) == before
        (data / "sourcedata/mine.txt").write_text("x")
        done("rm", data, *all_takes, "--raw", "--yes")
        stays = [p for p in dates if p.exists()]
        assert answer("import", data, corpus)["added"] == len(all_takes)
        assert contents(data).items() >= before.items()
        assert all(p.stat().st_mtime_ns == dates[p] for p in stays), "a file that was there was written anew"
        assert len(list((data / "sourcedata").iterdir())) == 2, "a folder of the unpacking is left"
    assert answer("build", folder / "set")["made"] == 3


@case
def what_a_killed_import_left_goes_with_the_next_one(folder):
    archive = zipped(small_bvh(folder, "anna/walk.bvh"), folder / "a.zip")
    done("import", folder / "set", archive)
    raw = folder / "set/sourcedata"
    own, = (p.name for p in raw.iterdir())
    over = subprocess.Popen(["true"])
    over.wait()
    left = {name: raw / name for name in (f".{own}-{over.pid}", f".{own}-{os.getpid()}", f".{own}-note", ".other-1-1")}
    for path in left.values():
        (path / "anna").mkdir(parents=True)
        (path / "anna/walk.bvh").write_text("half")
    assert answer("import", folder / "set", archive)["added"] == 0
    assert sorted(p.name for p in raw.iterdir()) == sorted([own, *list(left)[1:]]), list(raw.iterdir())


def zip_of(path, *names, data=b"x"):
    with zipfile.ZipFile(path, "w") as out:
        for name in names:
            out.writestr(name, data)


def zip_entry(path, **how):
    info = zipfile.ZipInfo("anna/walk.bvh")
    for name, value in how.items():
        setattr(info, name, value)
    with zipfile.ZipFile(path, "w") as out:
        out.writestr(info, "/etc/passwd")


def tar_of(path, *members):
    with tarfile.open(path, "w") as out:
        for name, how in members:
            info = tarfile.TarInfo(name)
            for key, value in how.items():
                setattr(info, key, value)
            out.addfile(info, io.BytesIO(b"x" * info.size))


def with_nul(path):
    zip_of(path, "anna/walkZ.bvh")
    path.write_bytes(path.read_bytes().replace(b"walkZ", b"walk\0"))


def encrypted(path):
    zip_of(path, "anna/walk.bvh")
    data = bytearray(path.read_bytes())
    for mark, at in ((b"PK\3\4", 6), (b"PK\1\2", 8)):
        where = data.index(mark) + at
        data[where] |= 1
    path.write_bytes(data)


def with_bad_bytes(path):
    zip_of(path, "anna/walk.bvh", data=b"many words " * 100)
    path.write_bytes(path.read_bytes().replace(b"many words many", b"many wards many", 1))


HOSTILE_ZIPS = [
    ("leads up", lambda p: zip_of(p, "anna/../../../evil.bvh"), "evil.bvh"),
    ("absolute", lambda p: zip_of(p, "/evil.bvh"), "/evil.bvh"),
    ("a drive", lambda p: zip_of(p, "C:evil.bvh"), "C:evil.bvh"),
    ("backslashes", lambda p: zip_of(p, "anna\\..\\..\\evil.bvh"), "evil.bvh"),
    ("a control character", lambda p: zip_of(p, "anna/ev\x1b[2Jil.bvh"), "il.bvh"),
    ("a NUL", with_nul, "anna/walk"),
    ("a name twice", lambda p: zip_of(p, "anna/walk.bvh", "anna/./walk.bvh"), "walk.bvh again"),
    ("a file in place of a folder", lambda p: zip_of(p, "anna", "anna/walk.bvh"), "anna/walk.bvh again"),
    ("a folder in place of a file", lambda p: zip_of(p, "anna/walk.bvh", "anna"), "anna again"),
    ("a link", lambda p: zip_entry(p, external_attr=(stat.S_IFLNK | 0o777) << 16), "a link, anna/walk.bvh"),
    ("a device", lambda p: zip_entry(p, external_attr=(stat.S_IFCHR | 0o777) << 16), "a device, anna/walk.bvh"),
    ("a password", encrypted, "anna/walk.bvh"),
    ("a wrong checksum", with_bad_bytes, "hostile.zip"),
    ("a long name", lambda p: zip_of(p, "a/" * 600 + "walk.bvh"), "a/a/a"),
]
HOSTILE_TARS = [
    ("leads up", lambda p: tar_of(p, ("../evil.bvh", {"size": 1})), "../evil.bvh"),
    ("absolute", lambda p: tar_of(p, ("/evil.bvh", {"size": 1})), "/evil.bvh"),
    ("a symbolic link", lambda p: tar_of(p, ("link", {"type": tarfile.SYMTYPE, "linkname": "/tmp"}),
                                         ("link/evil.bvh", {"size": 1})), "a link, link"),
    ("a hard link", lambda p: tar_of(p, ("link", {"type": tarfile.LNKTYPE, "linkname": "/etc/passwd"})), "a link, link"),
    ("a pipe", lambda p: tar_of(p, ("pipe", {"type": tarfile.FIFOTYPE})), "a device, pipe"),
    ("a device", lambda p: tar_of(p, ("null", {"type": tarfile.CHRTYPE, "devmajor": 1, "devminor": 3})), "a device, null"),
    ("a name twice", lambda p: tar_of(p, ("a.bvh", {"size": 1}), ("./a.bvh", {"size": 1})), "a.bvh again"),
]


@case
def an_archive_cant_write_outside_of_its_target_and_leaves_nothing_behind(folder):
    done("init", folder / "set")
    before = contents(folder)
    for ending, hostile in ((".zip", HOSTILE_ZIPS), (".tar", HOSTILE_TARS)):
        for what, make, naming in hostile:
            archive = folder / ("hostile" + ending)
            make(archive)
            for data in ("set", "fresh"):
                err = done("import", folder / data, archive, "--subject", "01", code=3)
                assert naming in err, f"{what}: {err}"
            archive.unlink()
            assert contents(folder) == before, f"{what}: {contents(folder).keys() - before.keys()}"
            assert sorted(p.name for p in folder.rglob("*")) == ["dataset.toml", "set"], what
            assert not list(folder.parent.glob("evil*")), what


@case
def a_small_archive_cant_fill_the_disk(folder):
    for name, make in (("bomb.zip", lambda p: zipfile.ZipFile(p, "w", zipfile.ZIP_DEFLATED)),
                       ("bomb.tar.gz", lambda p: tarfile.open(p, "w:gz"))):
        with make(folder / name) as out:
            if name.endswith("zip"):
                with out.open("anna/walk.bvh", "w") as member:
                    for _ in range(300):
                        member.write(b"0" * (1 << 20))
            else:
                info = tarfile.TarInfo("anna/walk.bvh")
                info.size = 300 << 20
                out.addfile(info, io.BytesIO(b"0" * info.size))
        assert (folder / name).stat().st_size < 1 << 20
        err = done("import", folder / "set", folder / name, code=3)
        assert "200 times" in err and "anna/walk.bvh" in err, err
        assert not (folder / "set").exists()


@case
def an_archive_cut_anywhere_is_an_error_or_whole(folder):
    source = small_bvh(folder, "anna/walk.bvh")
    for archive in (zipped(source, folder / "whole.zip"), tarred(source, folder / "whole.tar.gz", "w:gz")):
        data = archive.read_bytes()
        for end in [0, 1, 10, 100] + [len(data) * k // 8 for k in range(1, 8)] + [len(data) - 30, len(data) - 1]:
            part = folder / ("part" + "".join(archive.suffixes))
            part.write_bytes(data[:end])
            ran = kinalign("dataset", "import", folder / "set", part)
            law(ran, ("dataset", "import", folder / "set", part))
            if ran.returncode == 0:
                assert takes(folder / "set") == ["sub-anna_task-walk_run-01"]
                shutil.rmtree(folder / "set")
            assert not (folder / "set").exists(), end


def npz_with(folder, **changes):
    """CMU's packing of one clip of a chain of two joints."""
    arrays = {"planes": numpy.zeros((2, 9, 4), numpy.uint8), "joints": numpy.array(["hip", "knee"]),
              "parents": numpy.array([-1, 0], numpy.int8), "tip_parents": numpy.array([1], numpy.int8),
              "people": numpy.array(["02"]), "rest": numpy.array([[[0, 0, 0], [0, -0.5, 0]]], numpy.float32),
              "axis": numpy.zeros((1, 2, 3), numpy.float32), "tips": numpy.array([[[0, -0.4, 0]]], numpy.float32),
              "clip_person": numpy.array([0], numpy.int16), "clip_take": numpy.array(["02_05"]),
              "clip_class": numpy.array(["walk"]), "clip_text": numpy.array(["a walk"]),
              "clip_start": numpy.array([0], numpy.int32), "clip_len": numpy.array([4], numpy.int32),
              "rate": numpy.float32(60)}
    arrays.update(changes)
    numpy.savez_compressed(folder / "asf_00.npz", **{k: v for k, v in arrays.items() if v is not None})
    return folder / "asf_00.npz"


@case
def a_packed_clip_is_checked_before_anything_is_written(folder):
    whole = npz_with(folder)
    assert answer("import", folder / "set", whole)["added"] == 1
    assert takes(folder / "set") == ["sub-02_task-walk_run-05"]
    shutil.rmtree(folder / "set")
    for changes, naming in (({"rest": None}, "array rest"), ({"clip_len": numpy.array([5])}, "clip 0"),
                            ({"clip_person": numpy.array([-1])}, "clip 0"), ({"tip_parents": numpy.array([2])}, "tip_parents"),
                            ({"parents": numpy.array([-1, 1])}, "asf_00.npz"), ({"joints": numpy.array([1, 2])}, "joints"),
                            ({"planes": numpy.zeros((2, 8, 4), numpy.uint8)}, "planes"),
                            ({"planes": numpy.zeros((2, 9, 4), numpy.uint8, order="F")}, "C order"),
                            ({"clip_text": numpy.array([{"a": 1}], dtype=object)}, "numbers or texts"),
                            ({"rate": numpy.float32("nan")}, "rate"), ({"people": numpy.array([], "<U2")}, "people")):
        npz_with(folder, **changes)
        err = done("import", folder / "set", whole, code=3)
        assert naming in err, (changes, err)
        assert not (folder / "set").exists(), changes
    with zipfile.ZipFile(whole, "w") as out:
        out.writestr("planes.npy", b"\x93NUMPY\1\0" + struct.pack("<H", 76) + b"{'descr': '<f8', 'fortran_order': False, "
                     b"'shape': (999999999999,), }".ljust(76))
    assert "2^40" in done("import", folder / "set", whole, code=3)

if __name__ == "__main__":
    sys.exit(main())
