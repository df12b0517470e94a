# SPDX-License-Identifier: Apache-2.0
"""The time server as a program that runs while it is asked: for tests/apps/time_server*_check.py."""
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess

import cases
from cases import Skip, parsed

ALL_ADDRESSES = ("--port", "0", "--local-stratum", "10")
CLIENT = bytes([0x23, 0, 6, 0x20]) + bytes(36) + b"\x01\x02\x03\x04\x05\x06\x07\x08"  # as chrony's


class Server:
    """The real program, until the end of the block; then `counts` is what it said last."""

    def __init__(self, *words, prefix=(), sign=signal.SIGTERM):
        self.sign = sign
        self.program = subprocess.Popen([*prefix, str(cases.PROGRAM), "time-server", *words, "--json"],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.program.stdout.readline()
        assert line, self.program.communicate()[1]
        self.started = parsed(line)
        self.port = self.started["port"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.program.send_signal(self.sign)
        out, self.err = self.program.communicate(timeout=30)
        assert self.program.returncode == 0, (self.program.returncode, self.err)
        self.counts = parsed(out.splitlines()[-1])
        assert self.counts["event"] == "stopped", out

    def memory_kib(self):
        status = pathlib.Path(f"/proc/{self.program.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1])


def client(family=socket.AF_INET, seconds=2.0):
    one = socket.socket(family, socket.SOCK_DGRAM)
    one.settimeout(seconds)
    return one


def ask(server, request, address="127.0.0.1"):
    """The answer to a request that is to have one."""
    with client(socket.AF_INET6 if ":" in address else socket.AF_INET) as one:
        one.sendto(request, (address, server.port))
        return one.recvfrom(2048)[0]


def needs(*programs):
    for program in programs:
        if not shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin:/sbin"):
            raise Skip(f"no {program}")


def has_ipv6_loopback():
    try:
        with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as one:
            one.bind(("::1", 0))
        return True
    except OSError:
        return False
