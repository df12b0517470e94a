# SPDX-License-Identifier: Apache-2.0
"""Reads the archives of tests/formats/tar: tar_read.py FOLDER

expected.txt has a line for each member of small.tar: its name, its size and the CRC-32 of its bytes. shard.tar is
grouped as WebDataset does. large.tar, where it is there, has a member above 8 GiB.
"""
import pathlib
import subprocess
import sys
import tarfile
import zlib

folder = pathlib.Path(sys.argv[1])
wanted = [line.rsplit(" ", 2) for line in (folder / "expected.txt").read_text().splitlines()]
with tarfile.open(folder / "small.tar") as archive:
    found = archive.getmembers()
    assert [m.name for m in found] == [name for name, _, _ in wanted], found
    for member, (name, size, crc) in zip(found, wanted):
        assert member.isreg() and member.size == int(size), name
        assert (member.mtime, member.uid, member.gid, member.mode) == (0, 0, 0, 0o644), name
        assert (member.uname, member.gname) == ("", ""), name
        assert zlib.crc32(archive.extractfile(member).read()) == int(crc), name
listed = subprocess.run(["tar", "-tf", folder / "small.tar"], capture_output=True, text=True, check=True)
assert listed.stdout.splitlines() == [name for name, _, _ in wanted] and listed.stderr == "", listed

samples = []
with tarfile.open(folder / "shard.tar") as archive:
    for member in archive:  # webdataset.tariterators.group_by_keys
        key, ending = member.name.split(".", 1)
        if not samples or samples[-1]["__key__"] != key:
            samples.append({"__key__": key})
        assert ending not in samples[-1]
        samples[-1][ending] = archive.extractfile(member).read()
assert samples == [{"__key__": f"take0001_{k:05}", "positions.npy": bytes([k] * k), "json": b"{}", "cls": b"%d" % k}
                   for k in range(20)], samples[:2]

large = folder / "large.tar"
if large.exists():
    with tarfile.open(large) as archive:
        sizes = [(m.name, m.size) for m in archive]
    assert sizes == [("before", 1), ("large.npy", 2**33), ("behind", 1)], sizes
