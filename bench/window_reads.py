# SPDX-License-Identifier: Apache-2.0
"""How long any window of any take is on its way into an array: h5py, and our own reader.

Usage: window_reads.py BUILD DATA_SET [--windows N] [--rows N]
e.g.   bench/window_reads.py build/bench /tmp/hfut/set
Each window is another place of another take: open the file, read 240 rows. Our reader
checks each number. The files are read once before, so that they are in the page cache.
"""
import argparse
import pathlib
import random
import statistics
import subprocess
import sys
import time

import h5py


def row(name, seconds, bar):
    seconds = sorted(1e3 * s for s in seconds)
    print(f"{name:<44} median {statistics.median(seconds):.2f} ms, 99 % {seconds[int(0.99 * len(seconds))]:.2f} ms; bar {bar} ms")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--windows", type=int, default=1000)
    parser.add_argument("--rows", type=int, default=240)
    words = parser.parse_args()
    takes = sorted(words.data.glob("sub-*/*_take.h5"))
    if not takes:
        sys.exit(f"{words.data}: no takes")
    lengths = {}
    for take in takes:
        with h5py.File(take) as file:
            lengths[take] = len(file["time_ns"])
        with take.open("rb") as file:
            while file.read(1 << 24):
                pass
    chance = random.Random(1)
    places = []
    for _ in range(words.windows):
        take = chance.choice(takes)
        places.append((chance.randrange(max(1, lengths[take] - words.rows)), take))
    seconds = []
    for first, take in places:
        start = time.perf_counter()
        with h5py.File(take) as file:
            window = file["mocap/positions"][first:first + words.rows]
        seconds.append(time.perf_counter() - start)
        assert len(window)
    row("h5py, positions of the mocap", seconds, 2)
    lines = "".join(f"{first} {take}\n" for first, take in places)
    for name, part in (("our reader, positions of the mocap", ["mocap", "positions"]), ("our reader, all streams", [])):
        done = subprocess.run([words.build / "bench/window_reads", str(words.rows), *part], input=lines, capture_output=True,
                              text=True, check=True)
        row(name, [float(line) for line in done.stdout.split()], 0.5)


if __name__ == "__main__":
    main()
