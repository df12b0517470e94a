# SPDX-License-Identifier: Apache-2.0
"""Datagrams of docs/formats/imu_node.md in Python, written by that page alone: what the node is held against."""
import dataclasses
import struct
import zlib

FRAME, REPLY, REQUEST, ANSWER, CONFIRM = 1, 2, 3, 4, 5
MASK = (1 << 64) - 1


def rotated(x, by):
    return (x << by | x >> (64 - by)) & MASK


def siphash_2_4(key, data):
    """By the paper of Aumasson and Bernstein, section 2."""
    k0, k1 = struct.unpack("<2Q", key)
    v = [k0 ^ 0x736F6D6570736575, k1 ^ 0x646F72616E646F6D, k0 ^ 0x6C7967656E657261, k1 ^ 0x7465646279746573]

    def rounds(n):
        for _ in range(n):
            for a, b, turn in ((0, 1, 13), (2, 3, 16)):
                v[a] = (v[a] + v[b]) & MASK
                v[b] = rotated(v[b], turn) ^ v[a]
            v[0] = rotated(v[0], 32)
            for a, b, turn in ((2, 1, 17), (0, 3, 21)):
                v[a] = (v[a] + v[b]) & MASK
                v[b] = rotated(v[b], turn) ^ v[a]
            v[2] = rotated(v[2], 32)

    padded = data + bytes(7 - len(data) % 8) + bytes([len(data) & 255])
    for (word,) in struct.iter_unpack("<Q", padded):
        v[3] ^= word
        rounds(2)
        v[0] ^= word
    v[2] ^= 0xFF
    rounds(4)
    return v[0] ^ v[1] ^ v[2] ^ v[3]


# the vector of the paper's appendix A
assert siphash_2_4(bytes(range(16)), bytes(range(15))) == 0xA129CA6149BE45E5


def sealed(kind, origin, byte21, fields, key=None, flags=0, battery=0):
    """A whole datagram; origin: node id, boot id, sequence."""
    length = 24 + len(fields) + (8 if key else 0) + 4
    data = struct.pack(">4s2BH3I2BH", b"KAND", 1, kind, length, *origin, flags | (1 if key else 0), byte21, battery)
    data += fields
    if key:
        data += struct.pack("<Q", siphash_2_4(key, data))
    return data + struct.pack(">I", zlib.crc32(data))


def reply(origin, sequence, nonce, key=None, locked=False):
    return sealed(REPLY, origin, int(locked), struct.pack(">2IQ", sequence, nonce, 1_000_000), key)


def answer(origin, nonce, t2, t3, key=None):
    return sealed(ANSWER, origin, 0, struct.pack(">I2Q", nonce, t2, t3), key)


@dataclasses.dataclass
class Sample:
    age_us: int
    present: int
    values: list


@dataclasses.dataclass
class Datagram:
    """Any of a node's; what a type lacks is None."""
    kind: int
    origin: tuple
    battery: int | None
    n_tx: int | None
    echo: tuple | None
    samples: list
    times: tuple | None


def samples_of(fields, count):
    samples, at = [], 0
    for _ in range(count):
        age, present = struct.unpack_from(">IB", fields, at)
        n = 3 * (present & 1) + 3 * (present >> 1 & 1) + 4 * (present >> 2 & 1)
        samples.append(Sample(age, present, list(struct.unpack_from(f">{n}f", fields, at + 5))))
        at += 5 + 4 * n
    assert at == len(fields), "bytes behind the samples"
    return samples


def opened(data, key=None):
    """Checks everything that the page says of the head and the end, and takes the fields."""
    magic, version, kind, length, *origin, flags, byte21, battery = struct.unpack_from(">4s2BH3I2BH", data)
    assert (magic, version, length) == (b"KAND", 1, len(data)), data.hex()
    assert zlib.crc32(data[:-4]) == struct.unpack(">I", data[-4:])[0], "CRC"
    assert bool(flags & 1) == bool(key), "MAC's flag"
    end = len(data) - 4
    if key:
        end -= 8
        assert struct.unpack_from("<Q", data, end)[0] == siphash_2_4(key, data[:end]), "MAC"
    made = Datagram(kind, tuple(origin), battery if flags & 2 else None, None, None, [], None)
    fields = data[24:end]
    if kind == FRAME:
        made.n_tx, *echo = struct.unpack_from(">Q2IQ", fields)
        made.echo = tuple(echo) if flags & 4 else None
        made.samples = samples_of(fields[24:], byte21)
    elif kind == REQUEST:
        assert fields[:20] == bytes(20)
        made.samples = samples_of(fields[20:], byte21)
    else:
        made.times = struct.unpack(">I2Q", fields)
    return made
