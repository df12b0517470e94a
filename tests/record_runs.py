# SPDX-License-Identifier: Apache-2.0
"""The real recorder under the load of tools/record_load/main.cpp on loopback: for the test
tests/apps/record_load_check.py and the bench bench/record_load.py."""
import json
import os
import pathlib
import re
import signal
import subprocess
import time

from node_runs import cpu_seconds

DEVICES = ("mocap=noitom:udp:127.0.0.1:0", "kinect=kinect:udp:127.0.0.1:0", "imu=nodes:udp:127.0.0.1:0")


def resident_mb(pid):
    text = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", text)[1]) / 1024


class Recorder:
    """`kinalign record` with three ports, until end()."""

    def __init__(self, build, folder, *words):
        self.build = pathlib.Path(build)
        self.program = subprocess.Popen(
            [str(self.build / "apps/kinalign/kinalign"), "record", "-o", str(folder), "--json", *words,
             *(word for device in DEVICES for word in ("--device", device))],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.program.stdout.readline()
        assert line, self.program.communicate()[1]
        started = json.loads(line)
        self.ports, self.path = started["ports"], pathlib.Path(started["file"])
        os.set_blocking(self.program.stdout.fileno(), False)
        self.samples = []  # seconds since start, MB, open files

    def load(self, times, seconds, every_s=1.0):
        """The load, in full; what the recorder took meanwhile is in `samples` and `cpu_s`."""
        p = self.ports
        begin, cpu = time.monotonic(), cpu_seconds(self.program.pid)
        sender = subprocess.Popen(
            [str(self.build / "bench/record_load"), *map(str, (p["mocap"], p["kinect"], p["imu"], times, seconds))],
            stdout=subprocess.PIPE, text=True)
        while sender.poll() is None:
            time.sleep(every_s)
            self._drain()
            files = len(os.listdir(f"/proc/{self.program.pid}/fd"))
            self.samples.append((time.monotonic() - begin, resident_mb(self.program.pid), files))
        self.cpu_s, self.load_s = cpu_seconds(self.program.pid) - cpu, time.monotonic() - begin
        return json.loads(sender.stdout.read())

    def flood(self, rate, seconds):
        """Strangers at the mocap's port, beside the load."""
        port = str(self.ports["mocap"])
        return subprocess.Popen([str(self.build / "bench/node_flood"), port, port, str(rate), str(seconds)],
                                stdout=subprocess.DEVNULL)

    def _drain(self):
        """What it says meanwhile, which nobody needs: of a full pipe it would drop lines."""
        try:
            while os.read(self.program.stdout.fileno(), 1 << 16):
                pass
        except BlockingIOError:
            pass

    def end(self):
        """Ends it; the messages of each channel by its topic, as `kinalign info` reads the file."""
        self.program.send_signal(signal.SIGINT)
        os.set_blocking(self.program.stdout.fileno(), True)
        _, err = self.program.communicate(timeout=120)
        assert self.program.returncode == 0, (self.program.returncode, err)
        info = subprocess.run([str(self.build / "apps/kinalign/kinalign"), "info", str(self.path), "--json"],
                              capture_output=True, text=True, check=True)
        self.info = json.loads(info.stdout)
        return {channel["topic"]: channel["messages"] for channel in self.info["channels"]}


def lost(sent, recorded):
    """What was sent and is not there, by device."""
    out = {"mocap": sent["mocap"] - recorded.get("/mocap/raw", 0),
           "kinect": sent["kinect"] - recorded.get("/kinect/raw", 0)}
    for i, count in enumerate(sent["nodes"], 1):
        out[f"node {i}"] = count - recorded.get(f"/imu/{i}/raw", 0)
    return out
