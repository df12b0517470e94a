# SPDX-License-Identifier: Apache-2.0
"""clang-tidy on the files of kinalign/, apps/ and firmware/ that are not as they were when they passed.

A file has passed as it stands when <BUILD>/../tidy/ holds a stamp of its code (comments do not count,
but for NOLINT), of every header of ours that it reaches, and of .clang-tidy. So an unchanged tree costs nothing, and after a commit that
passed only what changed since then is looked at. A fresh clone has no stamps: with --changed the
commit before HEAD is taken to have passed, without it every file is looked at.
Usage: tidy.py BUILD [--jobs N] [--changed]
"""
import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
COMMENT = re.compile(r"//(?!.*NOLINT).*")


def reached(path, seen):
    """The files of ours that `path` includes, and theirs, with itself."""
    if path in seen or not path.is_file():
        return seen
    seen.add(path)
    for name in INCLUDE.findall(path.read_text()):
        reached(ROOT / name, seen)
    return seen


def stamp(path):
    """Changes when anything changes that clang-tidy sees of ours."""
    digest = hashlib.sha256((ROOT / ".clang-tidy").read_bytes())
    for part in sorted(reached(path, set())):
        code = " ".join(COMMENT.sub("", part.read_text()).split())
        digest.update(f"{part.relative_to(ROOT)}\0{code}\0".encode())
    return digest.hexdigest()


def tidy(path, build):
    run = subprocess.run(
        ["clang-tidy-14", "-p", str(build), "--quiet",
         # g++ alone knows some of our options and pragmas.
         "--extra-arg=-Wno-unknown-warning-option", "--extra-arg=-Wno-unknown-pragmas", str(path)],
        capture_output=True, text=True, check=False)
    return run.returncode, run.stdout


def sources(build):
    commands = json.loads((build / "compile_commands.json").read_text())
    files = sorted({pathlib.Path(c["file"]) for c in commands})
    ours = [f for f in files if f.relative_to(ROOT).parts[0] in ("kinalign", "apps", "firmware")]
    return [f for f in ours if not includes_torch(f)]


def includes_torch(path):
    """clang 14 can't compile LibTorch 1.13 as C++20 with g++ 12's library: an incomplete type in a vector."""
    return any("#include <torch/" in part.read_text() for part in reached(path, set()))


def changed_since_parent():
    """What differs from the commit before HEAD; None where there is none to compare with."""
    names = set()
    for command in (["diff", "--name-only", "HEAD~1"], ["ls-files", "--others", "--exclude-standard"]):
        try:
            git = subprocess.run(["git", *command], cwd=ROOT, capture_output=True, text=True, check=True)
        except (OSError, subprocess.CalledProcessError):
            return None
        names.update(ROOT / name for name in git.stdout.splitlines())
    return names


def assume(files, stamps, passed):
    """Leaves a stamp `.assumed` of each file that the last commit did not touch."""
    changed = changed_since_parent()
    if changed is None or ROOT / ".clang-tidy" in changed:
        return
    for path in files:
        if not changed & reached(path, set()):
            (passed / f"{stamps[path]}.assumed").touch()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--changed", action="store_true")
    asked = parser.parse_args()
    build = ROOT / asked.build
    passed = build.parent / "tidy"
    files = sources(build)
    stamps = {f: stamp(f) for f in files}
    if not passed.is_dir():
        passed.mkdir()
        if asked.changed:
            assume(files, stamps, passed)
    endings = ("", ".assumed") if asked.changed else ("",)
    todo = [f for f in files if not any((passed / (stamps[f] + e)).exists() for e in endings)]
    failed = False
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        for path, (code, text) in zip(todo, pool.map(lambda f: tidy(f, build), todo)):
            if code == 0:
                (passed / stamps[path]).touch()
            else:
                failed = True
                print(text or f"{path}: clang-tidy-14 failed", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
