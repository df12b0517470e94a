# SPDX-License-Identifier: Apache-2.0
"""Beside each NAME.frame of the folder, NAME.txt with what docs/formats/imu_node.md says it holds; floats by their
bits. The MAC is skipped: OpenSSL is its witness."""
import pathlib
import struct
import sys
import zlib


def said(data):
    magic, version, kind, length, *origin, flags, count, battery, n_tx = struct.unpack_from(">4s2BH3I2BHQ", data)
    (crc,) = struct.unpack_from(">I", data, length - 4)
    assert (magic, version, kind, length) == (b"KAND", 1, 1, len(data)) and crc == zlib.crc32(data[:-4])
    lines = [[*origin, n_tx]]
    if flags & 2:
        lines.append(["battery", battery])
    if flags & 4:
        lines.append(["echo", *struct.unpack_from(">2IQ", data, 32)])
    at = 48
    for _ in range(count):
        age, present = struct.unpack_from(">IB", data, at)
        at += 5
        line = ["sample", age, present >> 3]
        for bit, (name, n) in enumerate([("acceleration", 3), ("angular_velocity", 3), ("orientation", 4)]):
            if present & 1 << bit:
                line += [name, *(f"{x:x}" for x in struct.unpack_from(f">{n}I", data, at))]
                at += 4 * n
        lines.append(line)
    assert at + (8 if flags & 1 else 0) + 4 == length
    return "".join(" ".join(map(str, line)) + "\n" for line in lines)


for path in list(pathlib.Path(sys.argv[1]).glob("*.frame")):
    path.with_suffix(".txt").write_text(said(path.read_bytes()))
