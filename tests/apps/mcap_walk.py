# SPDX-License-Identifier: Apache-2.0
"""An MCAP file as https://mcap.dev/spec has it, read by hand: an independent witness of uncompressed recordings,
whole or torn."""
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"


def text(data, at):
    length = struct.unpack_from("<I", data, at)[0]
    return data[at + 4:at + 4 + length].decode(), at + 4 + length


def records(data, at=0):
    """(opcode, content) one after the other, up to where the bytes break off."""
    while at + 9 <= len(data):
        op, length = struct.unpack_from("<BQ", data, at)
        if at + 9 + length > len(data):
            return
        yield op, data[at + 9:at + 9 + length]
        at += 9 + length


def whole_chunks(data):
    """(where it ends, its messages) of each chunk of a whole file, by the message indexes that stand behind it:
    compressed ones, too."""
    chunks, at = [], 8
    for op, content in records(data, 8):
        at += 9 + len(content)
        if op == 0x06:
            chunks.append((at, 0))
        elif op == 0x07:
            end, messages = chunks[-1]
            chunks[-1] = end, messages + struct.unpack_from("<I", content, 2)[0] // 16
    return chunks


class Walk:
    """`messages`: (topic, sequence, log_time, publish_time, payload) of whole chunks whose checksum fits;
    `attachments`: the bytes by name; `channels`: the metadata by topic."""

    def __init__(self, path):
        data = path.read_bytes()
        assert data[:8] == MAGIC, data[:8]
        self.closed = data[-8:] == MAGIC and len(data) > 16
        self.messages, self.metadata, self.topics, self.ops = [], {}, {}, []
        self.attachments, self.channels = {}, {}
        for op, content in records(data[:-8] if self.closed else data, 8):
            self.ops.append(op)
            if op == 0x06:
                self.chunk(content)
            elif op == 0x09:
                name, at = text(content, 16)
                _, at = text(content, at)
                size = struct.unpack_from("<Q", content, at)[0]
                self.attachments[name] = content[at + 8:at + 8 + size]
            elif op == 0x0C:
                name, at = text(content, 0)
                self.metadata[name] = self.texts(content[at + 4:])

    @staticmethod
    def texts(content):
        found, at = {}, 0
        while at < len(content):
            key, at = text(content, at)
            found[key], at = text(content, at)
        return found

    def chunk(self, content):
        _, _, size, crc = struct.unpack_from("<QQQI", content, 0)
        compression, at = text(content, 28)
        assert compression == "", "an uncompressed recording"
        inner = content[at + 8:]
        assert len(inner) == size and zlib.crc32(inner) == crc
        for op, record in records(inner):
            if op == 0x04:
                channel = struct.unpack_from("<H", record)[0]
                self.topics[channel], at = text(record, 4)
                _, at = text(record, at)
                self.channels[self.topics[channel]] = self.texts(record[at + 4:])
            if op == 0x05:
                channel, sequence, log, publish = struct.unpack_from("<HIQQ", record)
                self.messages.append((self.topics[channel], sequence, log, publish, record[22:]))
