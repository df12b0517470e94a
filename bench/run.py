#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the kernels' benchmarks, ours and the references interleaved, and prints the table.

usage: run.py [BUILD=build/bench] [ROUNDS=7]

Each line: the job, what it is measured against, the ratio of the medians of CPU time, the aim; of
takes that wait for no disk the ratio of the minima of wall time, as their aim is stated.
"""
import collections
import json
import pathlib
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
MINIMA = ("take_unsynced/", "take_doubles/")
# job, ours, reference, in words, aim (ours / reference)
ROWS = [
    ("text to doubles", "parse/kinalign", "parse/from_chars", "`std::from_chars`", 0.75),
    ("a BVH file read, all checks", "bvh/kinalign", "bvh/from_chars",
     "`std::from_chars` from memory", 0.75),
    ("a Kinect CSV read, all checks", "csv/kinalign", "csv/from_chars",
     "`std::from_chars` from memory", 0.8),
    ("a take of 118 MB, synced", "take/kinalign/25/real_time", "take/write/25/real_time",
     "`write()` and `fsync` of the same bytes", 1.1),
    ("a take of 14 MB, not synced", "take_unsynced/kinalign/3/real_time",
     "take_unsynced/write/3/real_time", "`write()` of the same bytes", 1.4),
    ("a take of 19 MB of doubles, not synced", "take_doubles/kinalign/2/real_time",
     "take_doubles/write/4/real_time", "`write()` of the same bytes", 1.4),
    ("doubles of a file to text", "print_file_like/kinalign", "print_file_like/to_chars",
     "`std::to_chars`, shortest", 0.2),
    ("doubles of a file to text", "print_file_like/kinalign", "print_fixed/to_chars",
     "`std::to_chars`, four decimals", 0.2),
    ("any doubles to text", "print_any/kinalign", "print_any/to_chars",
     "`std::to_chars`, shortest", 1.05),
    ("59 joints: angles to positions", "kinematics/kinalign", "kinematics/eigen",
     "Eigen, joint by joint", 0.5),
    ("59 joints, into fresh memory", "kinematics_fresh/kinalign", "kinematics_fresh/traffic",
     "the same bytes read and written", 2),
    ("a network of 0.46 million weights, 900 frames", "network/kinalign", "network/eigen",
     "Eigen, for any processor", 0.5),
    ("the same frame by frame", "network_frame/kinalign", "network_frame/eigen",
     "Eigen, for any processor", 0.8),
    ("two GRUs of 256 units, frame by frame", "gru_step/kinalign", "gru_step/eigen",
     "Eigen, for any processor", 1),
    ("natural spline, whole file", "spline/kinalign", "spline/traffic",
     "the same bytes moved", None),
    ("natural spline, windows of 1000 rows", "spline_windows/kinalign", "spline/traffic",
     "the same bytes moved", 1.6),
    ("natural spline, windows into one slab", "spline_slabs/kinalign", "spline/traffic",
     "the same bytes moved", 1.6),
    ("natural spline, windows of 1000 rows", "spline_windows/kinalign", "spline/scipy",
     "SciPy `CubicSpline`", 1 / 30),
    ("slerp", "slerp/kinalign", "slerp/eigen", "Eigen's slerp", 0.65),
    ("slerp", "slerp/kinalign", "slerp/scipy", "SciPy `Slerp`", None),
    ("rotation spline", "rotation_spline/kinalign", "slerp/kinalign", "our slerp", 4),
    ("rotation spline", "rotation_spline/kinalign", "rotation_spline/scipy",
     "SciPy `RotationSpline`", 1 / 50),
    ("SHA-256 of a warm file", "sha256/kinalign", "sha256/read_and_openssl",
     "`read()` and OpenSSL", 1.15),
]


def nanoseconds(build, rounds):
    """Time of one item of each benchmark, ns: the median, of takes the minimum."""
    times = collections.defaultdict(list)
    for program in sorted((build / "bench").glob("*_bench")):
        answer = subprocess.run(
            [program, "--benchmark_format=json", f"--benchmark_repetitions={rounds}",
             "--benchmark_enable_random_interleaving=true", "--benchmark_min_time=0.2"],
            check=True, capture_output=True, text=True).stdout
        for run in json.loads(answer)["benchmarks"]:
            if run["run_type"] == "iteration":
                rate = run.get("items_per_second") or run["bytes_per_second"]
                times[run["run_name"].removesuffix(f"/repeats:{rounds}")].append(1e9 / rate)
    found = {name: min(of) if name.startswith(MINIMA) else statistics.median(of)
             for name, of in times.items()}
    peers = subprocess.run(["/usr/bin/python3", HERE / "peers" / "scipy_resampling.py"],
                           check=True, capture_output=True, text=True,
                           env={"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}).stdout
    return found | json.loads(peers)


def shown(ratio):
    return f"{ratio:.3g}" if ratio >= 0.1 else f"1/{1 / ratio:.0f}"


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE.parent / "build" / "bench")
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 7
    found = nanoseconds(build, rounds)
    print("| job | reference | ours / reference | aim | met |")
    print("| --- | --- | --- | --- | --- |")
    for job, ours, reference, words, aim in ROWS:
        ratio = found[ours] / found[reference]
        met = "" if aim is None else "yes" if ratio <= aim else "no"
        print(f"| {job} | {words} | {shown(ratio)} | {'' if aim is None else shown(aim)} | {met} |")


if __name__ == "__main__":
    main()
