# SPDX-License-Identifier: Apache-2.0
"""How long `kinalign align` takes over a lab's recording of seven devices, and how much memory.

Usage: lab_recording.py LAB_RECORDING SECONDS KINALIGN [OTHER_KINALIGN] [--rounds N]
e.g.   bench/lab_recording.py build/bench/lab_recording 600 build/release/apps/kinalign/kinalign
The programs run by turns; of each the median is shown. LAB_RECORDING is what bench/lab_recording.cpp became. With two
programs the last line says whether both made the same take.
"""
import argparse
import hashlib
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile


def align(program, folder):
    """Seconds of wall and of CPU, and MiB at most; leaves take.h5."""
    with tempfile.NamedTemporaryFile("r") as times:
        command = ["/usr/bin/time", "-o", times.name, "-f", "%e %U %S %M", program, "align", "recording.toml", "-o",
                   "take.h5", "--force"]
        code = subprocess.run(command, cwd=folder, capture_output=True, check=False).returncode
        if code > 1:
            sys.exit(f"{program}: exit code {code}")
        wall, user, system, kib = map(float, times.read().splitlines()[-1].split())
    return wall, user + system, kib / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lab_recording")
    parser.add_argument("seconds")
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    programs = [os.path.abspath(program) for program in given.programs]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([given.lab_recording, given.seconds, folder], check=True)
        print(f"{given.seconds} s, {(folder / 'take_01.mcap').stat().st_size / 1e6:.0f} MB")
        print("| program | wall, s | CPU, s | memory, MiB |\n| --- | --- | --- | --- |")
        runs, takes = {program: [] for program in programs}, {}
        for _ in range(given.rounds):
            for program in programs:
                runs[program].append(align(program, folder))
                takes[program] = hashlib.sha256((folder / "take.h5").read_bytes()).hexdigest()
        for program in programs:
            wall, cpu, mib = (statistics.median(column) for column in zip(*runs[program]))
            print(f"| {program} | {wall:.2f} | {cpu:.2f} | {mib:.0f} |")
    if len(programs) > 1:
        print("the same take" if len(set(takes.values())) == 1 else "takes that differ")


main()
