# SPDX-License-Identifier: Apache-2.0
"""An independent reader of C3D, after docs/formats/c3d.md: c3d_read.py FOLDER

Reads FOLDER/written.c3d (Intel, floats) and compares with positions.in [T,J,3] in metres, y up, and states.in [T,J].
"""
import struct
import sys

import numpy as np
from arrays import given

data = open(f"{sys.argv[1]}/written.c3d", "rb").read()
assert len(data) % 512 == 0 and data[:2] == b"\x02\x50"
points, analog, first, last, gap = struct.unpack_from("<5H", data, 2)
scale, data_block, samples, rate = struct.unpack_from("<fHHf", data, 12)
assert (analog, first, gap, scale, samples) == (0, 1, 0, -1.0, 0), (analog, first, gap, scale, samples)
blocks, processor = data[514], data[515]
assert processor == 84 and data_block == 2 + blocks

groups, parameters, at = {}, {}, 516
while data[at]:
    length, number = struct.unpack_from("<bb", data, at)
    name = data[at + 2:at + 2 + length].decode()
    behind = at + 2 + length
    offset, = struct.unpack_from("<H", data, behind)
    if number < 0:
        groups[-number] = name
    else:
        kind, count = struct.unpack_from("<bB", data, behind + 2)
        dimensions = list(data[behind + 4:behind + 4 + count])
        size = int(np.prod(dimensions, dtype=int)) * abs(kind)
        begin = behind + 4 + count
        assert begin + size + 1 == behind + offset, name
        value = data[begin:begin + size]
        if kind == -1:
            width = dimensions[0]
            value = [value[i:i + width].decode().rstrip() for i in range(0, size, width)]
        else:
            value = np.frombuffer(value, {2: "<u2", 4: "<f4"}[kind]).tolist()
        parameters[groups[number], name] = value
    at = behind + offset
assert at < 512 * (1 + blocks)

states = given("states", -1, points)
frames = len(states)
assert parameters["POINT", "USED"] == [points]
assert parameters["POINT", "UNITS"] == ["mm"] and parameters["POINT", "Y_SCREEN"] == ["+Z"]
assert parameters["POINT", "RATE"] == [rate] and abs(rate - 59.94) < 1e-5
assert parameters["POINT", "DATA_START"] == [data_block]
assert parameters["POINT", "FRAMES"] == [min(frames, 65535)] and last == min(frames, 65535)
low, high = parameters["TRIAL", "ACTUAL_END_FIELD"]
assert low + 65536 * high == frames and parameters["TRIAL", "ACTUAL_START_FIELD"] == [1, 0]
names = [n for k in range(1, 9) for n in parameters.get(("POINT", "LABELS" if k == 1 else f"LABELS{k}"), [])]
assert names == [f"M{k}" for k in range(points)], names[:3]

read = np.frombuffer(data, "<f4", 4 * frames * points, 512 * (data_block - 1)).reshape(frames, points, 4)
x, y, z, fourth = np.moveaxis(read.astype(float), -1, 0)
ours = np.stack((x, z, -y), axis=-1) / 1000
assert ((fourth < 0) == (states == 0)).all() and (fourth[states != 0] == 0).all()
wanted = given("positions", -1, points, 3)
wanted[states == 0] = 0.0
assert np.abs(ours - wanted).max() <= 2**-24 * np.abs(wanted).max(), np.abs(ours - wanted).max()
