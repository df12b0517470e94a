#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The time server against chronyd, both as servers on loopback, in turn, and prints the table.

usage: ntp_bench.py [BUILD=build/bench] [ROUNDS=9] [SECONDS=2]

16 requests are under way at any time. Once they come from all of 127/8 in turn, so that both servers
look each sender up and neither limits it (kinalign as it is; chronyd does not limit by itself). Once
from one address, which kinalign is told to exempt. Client and both servers run at the highest priority
that the caller may give, alike: p99 is otherwise that of whatever else the machine does.
"""
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
IN_FLIGHT = 16
# figure, in words, aim (ours / chronyd's); more is better where it is a rate
FIGURES = (("cpu_us", "CPU time per answer", 0.9), ("rate", "answers per second", 1.0),
           ("p50_us", "time to the answer, median", None), ("p99_us", "time to the answer, p99", 1.1))
WAYS = (("strangers", (1 << 24) - 2, ()), ("one client", 1, ("--exempt", "127.0.0.0/8")))


def cpu_ns(pid):
    """On a processor so far: of the main thread, which is the only one of both."""
    return int(pathlib.Path(f"/proc/{pid}/schedstat").read_text().split()[0])


def start_ours(build, port, words):
    return subprocess.Popen([build / "apps/kinalign/kinalign", "time-server", "--port", str(port), "--quiet",
                             "--local-stratum", "10", *words])


def start_chronyd(folder, port):
    conf = folder / "chrony.conf"
    conf.write_text(f"allow\nlocal stratum 10\nport {port}\ncmdport 0\nbindcmdaddress /\npidfile {folder}/pid\n")
    program = shutil.which("chronyd", path="/usr/sbin:/usr/bin")
    return subprocess.Popen([program, "-x", "-n", "-d", "-u", "root", "-f", conf],
                            stderr=subprocess.DEVNULL)


def measured(build, server, port, seconds, sources):
    before = cpu_ns(server.pid)
    said = subprocess.run([build / "bench/ntp_load", str(port), str(IN_FLIGHT), str(seconds), str(sources)],
                          check=True, capture_output=True, text=True).stdout
    found = json.loads(said)
    found["cpu_us"] = (cpu_ns(server.pid) - before) / 1e3 / found["answers"]
    found["rate"] = found["answers"] / found["elapsed_s"]
    return found


def compare(build, folder, rounds, seconds, way):
    name, sources, words = way
    servers = {"ours": (start_ours(build, 12380, words), 12380), "chronyd": (start_chronyd(folder, 12381), 12381)}
    runs = {which: [] for which in servers}
    try:
        time.sleep(1)
        for k in range(rounds):
            for which in sorted(servers, reverse=k % 2 == 1):  # who comes first changes
                runs[which].append(measured(build, *servers[which], seconds, sources))
    finally:
        for server, _ in servers.values():
            server.terminate()
            server.wait()
    for figure, words, aim in FIGURES:
        ours, theirs = (statistics.median(run[figure] for run in runs[which]) for which in ("ours", "chronyd"))
        ratio = ours / theirs
        met = "" if aim is None else "yes" if (ratio >= aim if figure == "rate" else ratio <= aim) else "no"
        print(f"| {words}, {name} | chronyd | {ratio:.3g} | {'' if aim is None else aim} | {met} "
              f"| {ours:,.4g} against {theirs:,.4g} |", flush=True)
    lost = {which: sum(run["lost"] for run in of) for which, of in runs.items()}
    if any(lost.values()):
        print(f"lost: {lost}", file=sys.stderr)


def main():
    try:
        os.nice(-19)
    except PermissionError:
        print("priority stays as it is: not permitted", file=sys.stderr)
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE.parent / "build/bench").resolve()
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 9
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 2
    print("| figure | reference | ours / reference | aim | met | |")
    print("| --- | --- | --- | --- | --- | --- |")
    for way in WAYS:
        with tempfile.TemporaryDirectory(prefix="kinalign-bench-") as name:
            compare(build, pathlib.Path(name), rounds, seconds, way)


if __name__ == "__main__":
    main()
