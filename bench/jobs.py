#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whole commands against their references, in turn, and prints the table.

usage: jobs.py [BUILD=build/bench] [ROUNDS=3] [--hfut]

A recording of 148,000 mocap frames at 59 joints (1/20 of HFUT-MMD's) is made by the generator and
aligned; --hfut makes and aligns all of it (2.96 M frames, 9.5 GB of text, as 14 takes).
"""
import json
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
FRAMES, RATE = 148_000, 60


def run(command, fine=(0,)):
    """CPU and wall seconds, peak MiB and standard output of a command; `fine`: exit codes of a job done."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    timed = ["/usr/bin/time", "-f", "%M", *map(str, command)]
    done = subprocess.run(timed, capture_output=True, text=True)
    if done.returncode not in fine:
        sys.exit(f"{' '.join(timed)}: {done.stderr}")
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"cpu": cpu, "wall": wall, "mib": int(done.stderr.split()[-1]) / 1024, "out": done.stdout}


def record(build, folder, seconds, takes=1):
    """A recording; the paper's transform, as the peer script has it."""
    run([build / "tools/kinalign_demo_recording", folder, "--seed", 1, "--seconds", seconds,
         "--takes", takes])
    for manifest in folder.rglob("recording.toml"):
        manifest.write_text(manifest.read_text().replace('method = "fit"', 'method = "paper"'))
    return sorted(folder.rglob("recording.toml"))


def align(build, manifest):
    take = manifest.with_name("take.h5")
    take.unlink(missing_ok=True)
    return run([build / "apps/kinalign/kinalign", "align", manifest, "-o", take],
               fine=(0, 1))  # 1: with warnings


def row(job, reference, ratio, aim, note=""):
    met = "yes" if ratio <= aim else "no"
    print(f"| {job} | {reference} | {ratio:.3g} | {aim:.3g} | {met} | {note} |", flush=True)


def whole_job(build, folder, rounds):
    manifest = record(build, folder / "job", FRAMES / RATE)[0]
    bvh = manifest.with_name("mocap.bvh")
    limits, ours = [], []
    for _ in range(rounds):
        limits.append(json.loads(run([build / "bench/text_limit", bvh])["out"])["cpu_s"])
        ours.append(align(build, manifest))
    limit, cpu = statistics.median(limits), statistics.median(o["cpu"] for o in ours)
    mib = max(o["mib"] for o in ours)
    row("raw to take, 148,000 frames", "`std::from_chars` over the BVH, CPU time", cpu / limit, 3.5,
        f"{cpu:.2f} CPU s, {mib:.0f} MiB")
    part = record(build, folder / "part", 20_000 / RATE)[0]
    for way in ("split", "loadtxt"):
        wall = statistics.median(align(build, part)["wall"] for _ in range(rounds))
        script = run(["env", "OPENBLAS_NUM_THREADS=1", "/usr/bin/python3", HERE / "peers/job.py",
                      part.with_name("mocap.bvh"), folder, way])
        seconds = json.loads(script["out"].splitlines()[-1])["seconds"]
        row("raw to take, 20,000 frames", f"the NumPy/SciPy/h5py script, `{way}`, wall time",
            wall / seconds, 0.1, f"script {script['mib']:.0f} MiB")

def hour(build, folder):
    manifest = record(build, folder / "hour", 3600)[0]
    ours = align(build, manifest)
    row("one take of an hour, 216,000 frames", "256 MiB", ours["mib"] / 256, 1.0,
        f"{ours['mib']:.0f} MiB, {ours['wall']:.1f} s")


def start_up(build, folder, rounds):
    source = folder / "data.c"
    source.write_text('#include <hdf5.h>\n#include <stdio.h>\nint main(int c, char** v) { unsigned a, '
                      'b, d; (void)v; if (c > 1) { H5get_libversion(&a, &b, &d); } puts("0"); }\n')
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "hdf5"], check=True,
                           capture_output=True, text=True).stdout.split()
    run(["cc", "-O2", source, "-o", folder / "data", *flags])
    commands = {"ours": [build / "apps/kinalign/kinalign", "--version"], "data": [folder / "data"]}
    seconds = {name: [] for name in commands}
    mib = 0.0
    for _ in range(10 * rounds):
        for name, command in commands.items():
            found = run(command)
            seconds[name].append(found["wall"])
            mib = max(mib, found["mib"] if name == "ours" else 0.0)
    row("`kinalign --version`", "a tiny program that links HDF5, wall time",
        statistics.median(seconds["ours"]) / statistics.median(seconds["data"]), 1.5,
        f"{mib:.0f} MiB")


def hfut(build, folder):
    cpu = wall = mib = limit = 0.0
    takes = 14
    for n in range(takes):  # one after the other: 9.5 GB need not lie on the disk at once
        manifest = record(build, folder / "hfut", 2_960_000 / takes / RATE)[0]
        limit += json.loads(run([build / "bench/text_limit", manifest.with_name("mocap.bvh")])["out"])["cpu_s"]
        ours = align(build, manifest)
        cpu, wall, mib = cpu + ours["cpu"], wall + ours["wall"], max(mib, ours["mib"])
        shutil.rmtree(folder / "hfut")
        print(f"take {n + 1} of {takes}: {ours['wall']:.1f} s", file=sys.stderr)
    row("raw to takes, 2.96 M frames in 14 takes", "`std::from_chars` over the BVHs, CPU time",
        cpu / limit, 3.5, f"{cpu:.1f} CPU s, {wall:.1f} s, {mib:.0f} MiB (bar 1024)")


def main():
    words = [word for word in sys.argv[1:] if word != "--hfut"]
    build = pathlib.Path(words[0] if words else HERE.parent / "build/bench").resolve()
    rounds = int(words[1]) if len(words) > 1 else 3
    print("| job | reference | ours / reference | aim | met | |")
    print("| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory(prefix="kinalign-bench-") as name:
        folder = pathlib.Path(name)
        start_up(build, folder, rounds)
        whole_job(build, folder, rounds)
        hour(build, folder)
        if "--hfut" in sys.argv:
            hfut(build, folder)


if __name__ == "__main__":
    main()
