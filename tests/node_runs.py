# SPDX-License-Identifier: Apache-2.0
"""Host nodes against the real time server on loopback, and what its stamps are off: for the test
tests/apps/node_receiver_check.py and the bench bench/node_flood.py."""
import json
import math
import os
import pathlib
import signal
import subprocess
import tempfile
import time

NS_READING = 600  # a counter stands for its microsecond: half of it, and rounding


class Server:
    """The program, until the end of the block; `lines` are then what it said."""

    def __init__(self, build, *words, lab_key=None):
        key = ("--lab-key", str(lab_key)) if lab_key else ()
        # A file, since nobody reads until the end: of a full pipe the program drops lines.
        self.out = tempfile.TemporaryFile("w+", encoding="utf-8")
        self.program = subprocess.Popen(
            [str(build / "apps/kinalign/kinalign"), "time-server", "--port", "0", "--node-port", "0",
             "--listen", "127.0.0.1", "--local-stratum", "10", *key, *words, "--json"],
            stdout=self.out, stderr=subprocess.PIPE, text=True)
        while not (line := self.first_line()):
            assert self.program.poll() is None, self.program.communicate()[1]
            time.sleep(0.02)
        self.started = json.loads(line)
        self.node_port, self.ntp_port = self.started["node_port"], self.started["port"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.cpu_s = cpu_seconds(self.program.pid)
        self.program.send_signal(signal.SIGTERM)
        _, self.err = self.program.communicate(timeout=60)
        self.out.seek(0)
        self.lines = [json.loads(line) for line in self.out]
        self.out.close()
        assert self.program.returncode == 0, (self.program.returncode, self.err)

    def first_line(self):
        text = os.pread(self.out.fileno(), 1 << 16, 0).decode()
        return text.partition("\n")[0] if "\n" in text else ""

    def said(self, event):
        return [line for line in self.lines if line["event"] == event]

    def node(self, node_id):
        """What it said last of a node."""
        return [line for line in self.said("node") if line["node_id"] == node_id][-1]


def cpu_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100


class Keys:
    """A lab key in a folder of its own, and those of nodes."""

    def __init__(self, build, folder):
        self.program = build / "apps/kinalign/kinalign"
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=folder))
        self.lab = self.folder / "lab.key"
        subprocess.run([self.program, "node-key", "--new-lab-key", self.lab, "--quiet"], check=True)

    def of(self, node_id):
        path = self.folder / f"node{node_id}.key"
        if not path.exists():
            subprocess.run([self.program, "node-key", "--lab-key", self.lab, "--node", str(node_id),
                            "-o", path, "--quiet"], check=True)
        return path


def start_node(build, port, node_id, *words, key=None):
    key = ("--key-file", str(key)) if key else ()
    return subprocess.Popen([str(build / "firmware/host_node"), "--server", f"127.0.0.1:{port}", "--id",
                             str(node_id), *key, *map(str, words)], stdout=subprocess.PIPE, text=True)


def ended(node):
    out, _ = node.communicate(timeout=120)
    assert node.returncode == 0, out
    return json.loads(out)


class Relay:
    """kinalign_relay; `floors` by the port under which the server knows a node, s up and down."""

    def __init__(self, build, port, link, seed, rate_hz):
        self.program = subprocess.Popen([str(build / "tools/kinalign_relay"), str(port), link, str(seed),
                                         str(rate_hz)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.port = int(self.program.stdout.readline())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        out, _ = self.program.communicate("", timeout=30)
        rows = [line.split() for line in out.splitlines()]
        self.floors = {int(port): (float(up), float(down)) for port, up, down in rows}


def true_ns(reports, line):
    """When the node's counter read what a line says, on the host's raw clock; None: of another life."""
    truths = [t for t in reports[line["node_id"]]["truth"] if t["boot_id"] == line["boot_id"]]
    read_us = line["counter_ns"] / 1000 + 0.5
    fitting = [t for t in truths if t["counter_us"] <= read_us]
    if not fitting:
        return None
    t = fitting[-1]
    return t["raw_ns"] + (read_us - t["counter_us"]) * 1000 / (1 + t["drift_ppm"] * 1e-6)


def errors_ms(server, reports, asymmetry_ms=lambda line: 0.0, after_s=10.0):
    """Of live stamps behind the first seconds; and how many certified intervals miss the truth."""
    begun, errors, outside = {}, [], 0
    for line in server.said("node"):
        truth = true_ns(reports, line) if "time_ns" in line else None
        if truth is None:
            continue
        if line["certainty"] == "certified":
            outside += not line["earliest_ns"] - NS_READING <= truth <= line["latest_ns"] + NS_READING
        begun.setdefault((line["node_id"], line["boot_id"]), truth)
        if truth - begun[line["node_id"], line["boot_id"]] >= after_s * 1e9:
            errors.append((line["time_ns"] - truth) / 1e6 - asymmetry_ms(line))
    return errors, outside


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))
