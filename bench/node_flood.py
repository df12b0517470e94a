# SPDX-License-Identifier: Apache-2.0
"""Five nodes with keys at 100 frames/s while strangers flood both ports of the real time server from
10,000 loopback addresses: node_flood.py BUILD [--rate 50000] [--seconds 10] [--runs 3]
Says for each run which share of their frames and of the answers to them came through, how far live
stamps were off the truth, and what the server took of a processor."""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests"))
from node_runs import Keys, Server, cpu_seconds, ended, errors_ms, rms, start_node, true_ns

NODES, BEFORE_S = 5, 12


def one_run(build, rate, seconds):
    with tempfile.TemporaryDirectory() as folder:
        keys = Keys(build, pathlib.Path(folder))
        with Server(build, lab_key=keys.lab) as server:
            nodes = [start_node(build, server.node_port, i, "--rate", 100, "--drift-ppm", 10 * i, "--seconds",
                                BEFORE_S + seconds + 1, key=keys.of(i)) for i in range(1, NODES + 1)]
            time.sleep(BEFORE_S)
            begin_ns, cpu = time.clock_gettime_ns(time.CLOCK_MONOTONIC_RAW), cpu_seconds(server.program.pid)
            flood = json.loads(subprocess.run(
                [build / "bench/node_flood", str(server.node_port), str(server.ntp_port), str(rate), str(seconds)],
                capture_output=True, text=True, check=True).stdout)
            cpu = cpu_seconds(server.program.pid) - cpu
            reports = {i + 1: ended(node) for i, node in enumerate(nodes)}
            time.sleep(0.5)
    sent = sum(report["sent"] for report in reports.values())
    heard = sum(server.node(i)["accepted"] for i in reports)
    answers = sum(report["accepted"] for report in reports.values())
    counts = server.said("node_counts")[-1]
    server.lines = [line for line in server.lines if line["event"] != "node" or
                    (true_ns(reports, line) or 0) >= begin_ns]
    errors, outside = errors_ms(server, reports, after_s=0)
    packets = sum(flood[kind] for kind in ("rubbish", "strangers", "spoofed", "requests"))
    return {"flood_per_s": packets / flood["seconds"], "frames": heard / sent, "answers": answers / counts["replies"],
            "rms_ms": rms(errors), "worst_ms": max(map(abs, errors)), "outside": outside,
            "server_cpu": cpu / flood["seconds"], "counts": counts}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--rate", type=int, default=50_000)
    parser.add_argument("--seconds", type=int, default=10)
    parser.add_argument("--runs", type=int, default=3)
    o = parser.parse_args()
    worst = 1.0
    for _ in range(o.runs):
        run = one_run(o.build.resolve(), o.rate, min(o.seconds, 60))
        worst = min(worst, run["frames"], run["answers"])
        print(f"{run['flood_per_s']:8.0f} packets/s: frames {100 * run['frames']:.2f} %, answers "
              f"{100 * run['answers']:.2f} %, live RMS {run['rms_ms']:.4f} ms, worst {run['worst_ms']:.4f} ms, "
              f"{run['outside']} outside; server {100 * run['server_cpu']:.0f} % of a processor; "
              f"load {os.getloadavg()[0]:.1f}", flush=True)
        causes = {k: v for k, v in run["counts"].items() if v and k not in ("event", "schema")}
        print("   ", causes, flush=True)
    return 0 if worst >= 0.99 else 1


if __name__ == "__main__":
    sys.exit(main())
