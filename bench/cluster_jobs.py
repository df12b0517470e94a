# SPDX-License-Identifier: Apache-2.0
"""A build by two tasks of a real Slurm on this machine beside one task, each with one thread.

Usage: cluster_jobs.py BUILD [--takes N] [--seconds S]       as root; needs slurmctld, slurmd, slurm-client and munge
e.g.   bench/cluster_jobs.py build/release
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--takes", type=int, default=12)
    parser.add_argument("--seconds", type=float, default=240)
    words = parser.parse_args()
    sys.path[:0] = [str(ROOT / "tests/apps"), str(ROOT / "tests")]
    sys.argv = [sys.argv[0], str(words.build)]
    from dataset_cluster_check import slurm
    program, maker = (words.build.resolve() / path for path in ("apps/kinalign/kinalign", "tools/kinalign_demo_recording"))
    folder = pathlib.Path(tempfile.mkdtemp())
    try:
        data = folder / "set"
        subprocess.run([program, "dataset", "init", data, "--template", "hfut-mmd"], check=True, stdout=subprocess.DEVNULL)
        for i in range(words.takes):
            raw = folder / f"raw{i}"
            subprocess.run([maker, raw, "--seconds", str(words.seconds + i), "--seed", str(i + 1)], check=True)
            subprocess.run([program, "dataset", "add", data, raw / "recording.toml", "--subject", f"{i % 12:02}", "--action",
                            "S2A01"], check=True, stdout=subprocess.DEVNULL)
        seconds = {}
        with slurm(folder) as env:
            for tasks in (1, 2, 1, 2):
                start = time.perf_counter()
                subprocess.run(["srun", f"-n{tasks}", program, "dataset", "build", data, "--all", "--jobs", "1"], check=True,
                               env=env, cwd=folder, stdout=subprocess.DEVNULL)
                seconds[tasks] = min(seconds.get(tasks, 1e9), time.perf_counter() - start)
        print(f"one task {seconds[1]:.2f} s, two tasks {seconds[2]:.2f} s: {seconds[1] / seconds[2]:.2f} x; bar 1.7 x")
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
