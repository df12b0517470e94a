# SPDX-License-Identifier: Apache-2.0
"""An independent writer of C3D, after docs/formats/c3d.md: c3d_files.py FOLDER

For each of Intel, DEC and MIPS a file of integers and one of floats, with 300 points (LABELS2), analog channels and
invalid points; further a file with zero bytes in front, one with more than 65,535 frames, one without a number of
frames. NAME.f8 holds what must be read: metres, y up, as doubles; NAME.u1 the states.
"""
import struct
import sys

import numpy as np

FOLDER = sys.argv[1]
INTEL, DEC, MIPS = 84, 85, 86


def vax(value):
    """VAX F from the definition: 0.1fraction * 2^(exponent - 128), upper half first."""
    if value == 0:
        return b"\0\0\0\0"
    mantissa, exponent = np.frexp(abs(value))  # mantissa in [0.5, 1)
    fraction = round((float(mantissa) - 0.5) * 2**24)
    bits = (value < 0) << 31 | (int(exponent) + 128) << 23 | fraction
    return struct.pack("<HH", bits >> 16, bits & 0xFFFF)


def f32(processor, value):
    value = float(np.float32(value))
    return vax(value) if processor == DEC else struct.pack(">f" if processor == MIPS else "<f", value)


def i16(processor, value):
    return struct.pack(">H" if processor == MIPS else "<H", value & 0xFFFF)


def parameter(processor, group, name, kind, dimensions, data, last=False):
    body = struct.pack("<bB", kind, len(dimensions)) + bytes(dimensions) + data + b"\x03why"
    offset = 0 if last else 2 + len(body)
    return struct.pack("<bb", -len(name), group) + name.encode() + i16(processor, offset) + body


def group(processor, number, name):
    return struct.pack("<bb", len(name), -number) + name.encode() + i16(processor, 2 + 4) + b"\x03who"


def labels(processor, number, name, texts):
    length = max(map(len, texts))
    return parameter(processor, number, name, -1, [length, len(texts)],
                     b"".join(t.ljust(length).encode() for t in texts))


def section(processor, names, unit, up, scale, rate, data_block, frames, extra=b""):
    out = b"\x01\x50\0" + bytes([processor])
    # parameters before their group, as the format allows
    out += parameter(processor, 5, "Used", 2, [], i16(processor, len(names)))
    out += group(processor, 5, "Point")
    out += parameter(processor, 5, "SCALE", 4, [], f32(processor, scale))
    out += parameter(processor, 5, "RATE", 4, [1], f32(processor, rate))
    out += parameter(processor, 5, "DATA_START", 2, [], i16(processor, data_block))
    out += parameter(processor, 5, "FRAMES", 2, [], i16(processor, min(frames, 65535)))
    out += labels(processor, 5, "LABELS", names[:255])
    if len(names) > 255:
        out += labels(processor, 5, "LABELS2", names[255:])
    out += parameter(processor, 5, "UNITS", -1, [4], unit.ljust(4).encode())
    if up:
        out += parameter(processor, 5, "Y_SCREEN", -1, [2], up.encode())
    out += group(processor, 9, "ANALOG")
    out += labels(processor, 9, "LABELS", ["Fx", "Fy", "EMG 1"])
    out += extra + parameter(processor, 9, "USED", 2, [], i16(processor, 3), last=True)
    return out + b"\0" * (-len(out) % 512)


def write(name, processor, floats, *, points, frames, unit="mm", up="+Z", rate=119.88, zeros=0, count=True, long=False):
    random = np.random.default_rng(len(name) + points)
    names = [f"M{k}" for k in range(points)]
    scale = -0.1 if floats else 0.25
    raw = random.integers(-8000, 8000, (frames, points, 3))
    raw[0, 0] = (1, -2, 3)
    invalid = random.random((frames, points)) < 0.1
    values = raw / 3.0 if floats else raw
    extra = b""
    if long:
        extra = group(processor, 3, "TRIAL")
        extra += parameter(processor, 3, "ACTUAL_START_FIELD", 2, [2], i16(processor, 1) + i16(processor, 0))
        extra += parameter(processor, 3, "ACTUAL_END_FIELD", 2, [2],
                           i16(processor, frames & 0xFFFF) + i16(processor, frames >> 16))
    stated = frames if count else 65535
    parameters = section(processor, names, unit, up, scale, rate, 0, stated, extra)
    parameters = section(processor, names, unit, up, scale, rate, 2 + len(parameters) // 512, stated, extra)
    blocks = len(parameters) // 512
    parameters = parameters[:2] + bytes([min(blocks, 255)]) + parameters[3:]
    header = b"\x02\x50" + b"".join(
        i16(processor, n) for n in (points, 6, 1, min(stated, 65535), 10)) + f32(processor, scale)
    header += i16(processor, 2 + blocks) + i16(processor, 2) + f32(processor, rate)
    data = bytearray()
    for t in range(frames):
        for j in range(points):
            if floats:
                data += b"".join(f32(processor, v) for v in values[t, j])
                data += f32(processor, -1.0 if invalid[t, j] else 0x0304)
            else:
                data += b"".join(i16(processor, int(v)) for v in values[t, j])
                data += i16(processor, -1 if invalid[t, j] else 0x0304)
        data += b"".join(f32(processor, a) if floats else i16(processor, a) for a in range(6))
    data += b"\0" * (-len(data) % 512)
    with open(f"{FOLDER}/{name}.c3d", "wb") as out:
        out.write(b"\0" * zeros + header.ljust(512, b"\0") + parameters + data)
    ours = (np.float32(values).astype(float) if floats else scale * values) * {"mm": 0.001, "m": 1.0}[unit]
    x, y, z = np.moveaxis(ours, -1, 0)
    ours = np.stack({"+Z": (x, z, -y), "+Y": (x, y, z), "": (x, z, -y)}[up], axis=-1)
    ours[invalid] = 0.0
    ours.astype("<f8").tofile(f"{FOLDER}/{name}.f8")
    np.where(invalid, 0, 2).astype("u1").tofile(f"{FOLDER}/{name}.u1")


for machine, number in (("intel", INTEL), ("dec", DEC), ("mips", MIPS)):
    write(f"{machine}_floats", number, True, points=300, frames=7)
    write(f"{machine}_integers", number, False, points=300, frames=7, unit="m", up="+Y")
write("zeros_in_front", INTEL, True, points=2, frames=5, zeros=640, up="")
write("long", INTEL, False, points=1, frames=70_001, long=True)
write("uncounted", INTEL, False, points=1, frames=5, count=False)
