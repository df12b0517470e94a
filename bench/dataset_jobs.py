# SPDX-License-Identifier: Apache-2.0
"""A data set of HFUT-MMD's composition (2.96 M frames of mocap in 379 takes) from raw files to the paper's tables.

Usage: dataset_jobs.py BUILD [FOLDER] [--divisor N]
e.g.   bench/dataset_jobs.py build/release /tmp/hfut
Makes the raw files (9.5 GB of text), adds and builds them, and asks the index. Prints a row for each, and whether the tables
are the paper's. FOLDER needs 20 GB; a temporary one is taken where none is named. With --divisor each count is so much smaller.
"""
import argparse
import json
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests"))
import hfut


def timed(command, fine=(0,)):
    """Standard output, wall and CPU seconds of a command."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode not in fine:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.stdout, wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def raw_files(build, folder, takes):
    """The manifest of each take's raw files."""
    manifests = []
    for i, (_, _, frames, kinect, imu) in enumerate(takes):
        place = folder / f"raw/{i:03}"
        manifest = place / "recording.toml"
        if not manifest.exists():
            place.mkdir(parents=True, exist_ok=True)
            timed([build / "tools/kinalign_demo_recording", place, "--seconds", f"{frames / 60:.9f}", "--seed", i])
            for stream, wanted in (("kinect", kinect), ("imu", imu)):
                if not wanted:
                    hfut.without(manifest, stream)
        manifests.append(manifest)
    return manifests


def expected(takes):
    heights = {person: (sex, height) for ids, sex, height, *_ in hfut.PEOPLE for person in ids}
    return hfut.sums(takes, lambda take: take[1][:2]), hfut.sums(takes, lambda take: heights[take[0]])


def check_tables(tables, takes):
    by_class, by_person = expected(takes)
    counts = ("mocap", "kinect", "imu")
    assert {row["class"]: [row[c] for c in counts] for row in tables["classes"][:-1]} == by_class
    assert {(row["sex"], row["height_cm"]): [row[c] for c in counts] for row in tables["subjects"][:-1]} == by_person
    return sum(tables["classes"][-1][c] for c in counts)


def row(job, figure, note=""):
    print(f"| {job} | {figure} | {note} |", flush=True)


def run(build, folder, takes):
    kinalign = build / "apps/kinalign/kinalign"
    data = folder / "set"
    shutil.rmtree(data, ignore_errors=True)
    manifests = raw_files(build, folder, takes)
    timed([kinalign, "dataset", "init", data, "--template", "hfut-mmd"])
    start = time.perf_counter()
    for manifest, (subject, action, *_) in zip(manifests, takes):
        timed([kinalign, "dataset", "add", data, manifest, "--subject", subject, "--action", action])
    print("| job | figure | note |\n| --- | --- | --- |")
    row("added, one call each", f"{1e3 * (time.perf_counter() - start) / len(takes):.1f} ms a take", f"{len(takes)} takes")
    said, wall, cpu = timed([kinalign, "dataset", "build", data, "--json"], fine=(0, 1))
    row("built from raw files", f"{wall:.1f} s", f"{cpu:.1f} CPU s; {json.loads(said)['made']} takes")
    said, wall, cpu = timed([kinalign, "dataset", "build", data, "--json"])
    row("built again, nothing to do", f"{wall:.2f} s", "")
    shutil.rmtree(data / ".kinalign")
    said, wall, cpu = timed([kinalign, "dataset", "list", data])
    row("indexed from nothing", f"{wall:.2f} s", "aim 1 s")
    time.sleep(2.5)
    timed([kinalign, "dataset", "list", data])
    for name, words in (("listed", ["list", data]), ("queried", ["query", data, "class = 'S2' and frames > 6000"])):
        walls = [timed([kinalign, "dataset", *words])[1] for _ in range(11)]
        row(name, f"{1e3 * statistics.median(walls):.1f} ms", "aim 20 ms, with the program's start")
    said, wall, _ = timed([kinalign, "dataset", "tables", data, "--json"])
    row("tables 6 and 7", f"{1e3 * wall:.1f} ms", f"as the paper's; {check_tables(json.loads(said), takes):,} frames in all")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path, nargs="?")
    parser.add_argument("--divisor", type=int, default=1)
    given = parser.parse_args()
    takes = [take for take in hfut.composition(given.divisor) if take[2] >= 60]
    if given.folder:
        given.folder.mkdir(parents=True, exist_ok=True)
        return run(given.build, given.folder, takes)
    with tempfile.TemporaryDirectory() as folder:
        return run(given.build, pathlib.Path(folder), takes)


main()
