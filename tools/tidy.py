# SPDX-License-Identifier: Apache-2.0
"""clang-tidy on the files of kinalign/ and apps/ that are not as they were when they passed.

A file has passed as it stands when <BUILD>/../tidy/ holds a stamp of its text, of every header of
ours that it reaches, and of .clang-tidy. So an unchanged tree costs nothing, and after a commit that
passed only what changed since then is looked at: usage: tidy.py BUILD [--jobs N]
"""
import concurrent.futures
import hashlib
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)


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
        digest.update(str(part.relative_to(ROOT)).encode() + b"\0" + part.read_bytes())
    return digest.hexdigest()


def tidy(path, build):
    run = subprocess.run(
        ["clang-tidy-14", "-p", str(build), "--quiet",
         "--extra-arg=-Wno-unknown-warning-option", str(path)],
        capture_output=True, text=True, check=False)
    return run.returncode, run.stdout


def main():
    build = ROOT / sys.argv[1]
    jobs = int(sys.argv[sys.argv.index("--jobs") + 1]) if "--jobs" in sys.argv else 2
    passed = build.parent / "tidy"
    passed.mkdir(exist_ok=True)
    commands = json.loads((build / "compile_commands.json").read_text())
    files = sorted({pathlib.Path(c["file"]) for c in commands})
    files = [f for f in files if f.is_relative_to(ROOT / "kinalign") or f.is_relative_to(ROOT / "apps")]
    stamps = {f: stamp(f) for f in files}
    todo = [f for f in files if not (passed / stamps[f]).exists()]
    failed = False
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for path, (code, text) in zip(todo, pool.map(lambda f: tidy(f, build), todo)):
            if code == 0:
                (passed / stamps[path]).touch()
            else:
                failed = True
                print(text or f"{path}: clang-tidy-14 failed")
    return 1 if failed else 0


sys.exit(main())
