# SPDX-License-Identifier: Apache-2.0
"""kinalign record as a program, and devices that send to it."""
import atexit
import contextlib
import json
import os
import pathlib
import random
import signal
import socket
import struct
import subprocess
import threading
import time

import cases


def first_event(program, name="started"):
    """The event that it begins with; a disk may need its time before."""
    for line in program.stdout:
        event = json.loads(line)
        if event["event"] == "begin_waits":
            continue
        assert event["event"] == name, line
        return event
    raise AssertionError(program.communicate()[1])


class Recording:
    """The real program with a mocap port, until it is told to end. `first`: the event that it begins with."""

    def __init__(self, folder, *words, device="mocap=noitom:udp:127.0.0.1:0", first="started", env=None):
        device = ["--device", device] if device else []
        self.program = subprocess.Popen(
            [str(cases.PROGRAM), "record", "-o", str(folder), *device, "--compression", "none", "--json",
             *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env={**os.environ, **(env or {})})
        atexit.register(self.program.kill)  # where a case fails in the middle
        self.started = first_event(self.program, first)
        self.port = self.started["ports"].get("mocap")
        self.path = pathlib.Path(self.started.get("file", ""))

    def until(self, event):
        """What it says up to an event of that name, with it."""
        said = []
        while not said or said[-1]["event"] != event:
            line = self.program.stdout.readline()
            assert line, (event, said)
            said.append(json.loads(line))
        return said

    def end(self, sign=signal.SIGINT):
        self.program.send_signal(sign)
        out, err = self.program.communicate(timeout=60)
        return self.program.returncode, [json.loads(line) for line in out.splitlines()], err


def frame(number):
    """A suit's with the new header: its index, 354 values."""
    return struct.pack("<H4BHBBI32sI12sH", 0xDDFF, 0, 0, 1, 1, 354, 1, 0, 1, b"Char01", number, b"", 0xEEFF) + bytes(1416)


class Sender(threading.Thread):
    """Frames of a suit, 200 a second; when each was sent."""

    def __init__(self, port):
        super().__init__()
        self.to, self.sent, self.going = ("127.0.0.1", port), [], True

    def run(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
            while self.going:
                one.sendto(frame(len(self.sent)), self.to)
                self.sent.append(time.monotonic())
                time.sleep(0.005)

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.going = False
        self.join()


def numbers(walk):
    """Of the frames, in their order."""
    return [struct.unpack_from("<I", payload, 46)[0] for topic, *_, payload in walk.messages if topic == "/mocap/raw"]


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@contextlib.contextmanager
def sender_to(port):
    """A call sends a datagram; all of them from one port."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        yield lambda data: one.sendto(data if isinstance(data, bytes) else data.encode(), ("127.0.0.1", port))


def send(port, data):
    with sender_to(port) as to:
        to(data)


def mark(ports, kind):
    """A mark by a call, which no other repeats."""
    send(ports["marks"], json.dumps({"schema": "kinalign.mark/1", "kind": kind, "id": str(random.random())}))
