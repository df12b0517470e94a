# SPDX-License-Identifier: Apache-2.0
"""The index of 100,000 takes: made, brought up to date by one take, listed, filtered; beside Python's sqlite3 with the same rows.

Usage: index_jobs.py BUILD [FOLDER] [--takes N]
e.g.   bench/index_jobs.py build/release /tmp/index
Summaries are written without their takes: the index reads nothing else. Our times are those of the whole program, with its
start; the start alone (`kinalign --version`) stands beside them. Python's are those of the statement in a program that runs.
"""
import argparse
import json
import pathlib
import random
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time

CHANCE = random.Random(1)


def summary(subject, action):
    """A take as `build` would have summarised it."""
    frames = CHANCE.randrange(3000, 9000)
    hexes = "%064x" % CHANCE.getrandbits(256)
    stream = {"columns": 25, "valid": CHANCE.random(), "inferred": 0.1, "gaps": 2, "gap_s": 0.5}
    return {"schema": "kinalign.take_summary/1", "subject": subject, "action": action, "frames": frames, "rate_hz": 60.0,
            "begin_ns": 0, "end_ns": 1, "verdict": CHANCE.choice(("good", "usable", "bad")), "errors": 0, "warnings": 0,
            "worst": "", "streams": [{**stream, "name": "mocap", "modality": "mocap"},
                                     {**stream, "name": "kinect", "modality": "kinect", "interval_ns": 1000}],
            "inputs": [], "software": "kinalign 0", "recipe": hexes, "sha256": hexes, "bytes": 1, "residual_m": 0.05}


def place(folder, i):
    subject, action = f"{i % 12:02}", f"S{i % 6 + 1}A{i % 34 + 1:02}"
    name = f"sub-{subject}_task-{action}_run-{i // 12 + 1:02}"
    return folder / f"sub-{subject}" / f"{name}_take.json", subject, action


def timed(words, times=11):
    seconds = []
    for _ in range(times):
        start = time.perf_counter()
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
        seconds.append(time.perf_counter() - start)
        if done.returncode != 0:
            sys.exit(f"{words}: {done.stderr}")
    return statistics.median(seconds), done.stdout


def peer(takes):
    """The same rows in Python's sqlite3, and its answers."""
    database = sqlite3.connect(":memory:", isolation_level=None)
    database.execute("create table take(name text unique, subject text, class text, action text, frames int, verdict text, "
                     "seconds real, residual real)")
    start = time.perf_counter()
    database.execute("begin")
    database.executemany("insert into take values(?,?,?,?,?,?,?,?)", takes)
    database.execute("commit")
    database.executescript("create index a on take(subject, class, action); create index b on take(verdict, frames);")
    return database, time.perf_counter() - start


QUERIES = (
    ("by person, class and action", ["list", "--subject", "03", "--class", "S4", "--action", "S4A04", "--limit", "50"],
     "select name, frames from take where subject = '03' and class = 'S4' and action = 'S4A04' order by name limit 50"),
    ("worst, longest first", ["list", "--verdict", "bad", "--sort", "frames-", "--limit", "50"],
     "select name, frames from take where verdict = 'bad' order by frames desc limit 50"),
    ("a condition", ["query", "residual_cm > 4 and frames > 8990", "--limit", "50"],
     "select name, frames from take where residual > 0.04 and frames > 8990 order by name limit 50"),
    ("frames by class", ["query", "select class, count(*), sum(frames) from takes group by class"],
     "select class, count(*), sum(frames) from take group by class"),
    ("sum over all", ["query", "select sum(seconds), avg(residual_cm) from takes"],
     "select sum(seconds), avg(residual) from take"),
    ("one by its name", ["query", "name = 'sub-05_task-S6A18_run-01'"],
     "select name, frames from take where name = 'sub-05_task-S6A18_run-01'"),
)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path, nargs="?")
    parser.add_argument("--takes", type=int, default=100_000)
    words = parser.parse_args()
    program = words.build / "apps/kinalign/kinalign"
    folder = (words.folder or pathlib.Path(tempfile.mkdtemp())) / "set"
    if not folder.exists():
        subprocess.run([program, "dataset", "init", folder, "--template", "hfut-mmd"], check=True, stdout=subprocess.DEVNULL)
        for i in range(words.takes):
            path, subject, action = place(folder, i)
            path.parent.mkdir(exist_ok=True)
            path.write_text(json.dumps(summary(subject, action)))
    rows = []
    for i in range(words.takes):
        path, subject, action = place(folder, i)
        one = json.loads(path.read_text())
        rows.append((path.name[:-10], subject, action[:2], action, one["frames"], one["verdict"], one["frames"] / 60,
                     one["residual_m"]))
    for old in (folder / ".kinalign").glob("*"):
        old.unlink()
    start, _ = timed([program, "--version"])
    print(f"start of the program {1e3 * start:.1f} ms")
    made, _ = timed([program, "dataset", "query", folder, "select count(*) from takes"], times=1)
    database, theirs = peer(rows)
    print(f"{words.takes} takes into the index {made:.2f} s, {1e3 * made / words.takes:.3f} ms a take; "
          f"Python from memory {theirs:.2f} s")
    for name, ours, sql in QUERIES:
        verb, *rest = ours
        seconds, _ = timed([program, "dataset", verb, folder, *rest])
        peers = []
        for _ in range(11):
            begin = time.perf_counter()
            database.execute(sql).fetchall()
            peers.append(time.perf_counter() - begin)
        print(f"{name:<30} {1e3 * seconds:6.1f} ms, less the start {1e3 * (seconds - start):6.1f}; "
              f"Python's sqlite3 {1e3 * statistics.median(peers):6.1f} ms; bar 20 ms")
    path, subject, action = place(folder, words.takes + 1)
    path.write_text(json.dumps(summary(subject, action)))
    one, _ = timed([program, "dataset", "query", folder, "select count(*) from takes"], times=1)
    path.unlink()
    print(f"one take added to a person of {words.takes // 12}: {1e3 * one:.0f} ms")


if __name__ == "__main__":
    main()
