# SPDX-License-Identifier: Apache-2.0
"""Devices that are simulated live, recorded and held against their truth, on ports of their own."""
import json
import pathlib
import signal
import subprocess
import time

import cases
from cases import BUILD, done_with, kinalign
from mcap_walk import Walk
from recording_program import first_event, free_port

NODES = ["waist", "wrist_left", "wrist_right", "ankle_left", "ankle_right"]


def truth_of(folder):
    return json.loads((folder / "truth/truth.json").read_text())


def drawn_ports():
    """Flags of simulate --live: none of the usual ports, which others may have."""
    return [str(word) for name in ("mocap", "kinect", "node", "marks") for word in (f"--{name}-port", free_port())]


class Recorder:
    """kinalign record for a suit, a Kinect and nodes on ports of its own."""

    def __init__(self, folder):
        folder.mkdir()
        places = ", ".join(f'"{i}" = "{node}"' for i, node in enumerate(NODES, 1))
        (folder / "lab.toml").write_text('[device.imu]\nprotocol = "nodes"\naddress = "127.0.0.1"\nport = 0\n'
                                         f"nodes = {{ {places} }}\n")
        self.program = subprocess.Popen(
            [str(cases.PROGRAM), "record", "-o", str(folder), "--compression", "none", "--json", "--device",
             "mocap=noitom:udp:127.0.0.1:0", "--device", "kinect=kinect:udp:127.0.0.1:0", "--config",
             str(folder / "lab.toml"), "--marks-port", "0"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.started = first_event(self.program)

    def flags(self):
        ports = self.started["ports"]
        return ["--mocap-port", ports["mocap"], "--kinect-port", ports["kinect"], "--node-port", ports["imu"],
                "--marks-port", ports["marks"]]

    def end(self):
        self.program.send_signal(signal.SIGINT)
        out, err = self.program.communicate(timeout=60)
        assert self.program.returncode == 0, err
        return [json.loads(line) for line in out.splitlines()][-1], Walk(pathlib.Path(self.started["file"]))


def recorded(folder, *words, seconds=6):
    recorder = Recorder(folder / "takes")
    done = kinalign("simulate", "built-in", "-o", folder / "r", "--live", "--seconds", seconds, "--json", *words,
                    *recorder.flags())
    assert done.returncode == 0, done.stderr
    begun, sent = (json.loads(line) for line in done.stdout.decode().splitlines())
    time.sleep(0.2)
    stopped, walk = recorder.end()
    return begun, sent, stopped, walk, truth_of(folder / "r")


def recorded_by_its_lab(folder, seconds=6):
    """A live rehearsal as its page has it, recorded with the lab.toml that it writes: skeleton and places stand in
    the file. takes/03_S1A02_01.mcap, as help pages call it; the truth is in r/truth."""
    with subprocess.Popen([str(cases.PROGRAM), "simulate", "built-in", "-o", str(folder / "r"), "--live", "--begin-in",
                           "2", "--seconds", str(seconds), "--quiet", *drawn_ports()]) as simulation:
        while not (folder / "r/lab.toml").exists():
            assert simulation.poll() is None, simulation.returncode
            time.sleep(0.05)
        done_with(0, "record", "-o", folder / "takes", "--config", folder / "r/lab.toml", "--subject", "03", "--action",
                  "S1A02", "--seconds", seconds + 3, "--compression", "none", "--quiet")
        assert simulation.wait(30) == 0
    return folder / "takes/03_S1A02_01.mcap"


def truth_table(recording, take, truth):
    """What kinalign_truth_table ended with and said, and the lines of both its tables as lists of cells."""
    done = subprocess.run([BUILD / "tools/kinalign_truth_table", recording, take, truth], capture_output=True,
                          text=True, timeout=60, check=False)
    return done.returncode, done.stdout + done.stderr, table_rows(done.stdout)


def table_rows(text):
    """Without their heads."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line]
    return [row for row in rows if not row[0].startswith(("---", "device", "values"))]
