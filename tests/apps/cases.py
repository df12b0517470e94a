# SPDX-License-Identifier: Apache-2.0
"""Cases that drive the real program: a sentence each, counted like the others (tests/main.cpp)."""
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
from run_cases import Skip, case, in_time, run_cases  # noqa: F401 - they are handed on

BUILD = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/dev").resolve()
PROGRAM = BUILD / "apps/kinalign/kinalign"
DEMO = BUILD / "tools/kinalign_demo_recording"
SANITIZED = BUILD.name in ("asan", "tsan")  # sanitizers reserve terabytes of addresses
WRITES_ITSELF = BUILD.name == "tsan"  # a file of its own into TMPDIR, at every start
LONG = bool(os.environ.get("KINALIGN_LONG_TESTS"))  # the same sweeps, finer


def limits(memory, file_size):
    def set_limits():
        if not SANITIZED:
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        if file_size is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return set_limits


def kinalign(*words, cwd=None, memory=1 << 30, file_size=None, seconds=60, prefix=(), env=None):
    """Runs the program within bounds; a hang raises TimeoutExpired."""
    return subprocess.run([*map(str, prefix), str(PROGRAM), *map(str, words)], cwd=cwd, timeout=seconds,
                          capture_output=True, stdin=subprocess.DEVNULL, check=False,
                          preexec_fn=limits(memory, file_size), env={**os.environ, **(env or {})})


def unique(pairs):
    """An object of JSON whose names differ."""
    names = [name for name, _ in pairs]
    assert len(set(names)) == len(names), f"a name stands twice: {names}"
    return dict(pairs)


def parsed(text):
    """JSON that any reader takes for the same."""
    return json.loads(text, object_pairs_hook=unique)


def law(done, words, out=None):
    """What holds for every call with files of any content."""
    err = done.stderr.decode("utf-8", "backslashreplace")
    said = f"{' '.join(map(str, words))}\nexit {done.returncode}\n{err[:2000]}"
    assert done.returncode in (0, 1, 2, 3, 130), said
    for stream in (done.stdout, done.stderr):
        assert not re.search(rb"[\x00-\x09\x0b-\x1f\x7f]", stream), "control characters: " + said
    if done.returncode in (2, 3):
        assert done.stdout == b"", "stdout of a failure: " + said
        verb = " ".join(map(str, words[:2])) if words[0] in ("dataset", "model", "benchmark") else words[0]
        assert re.fullmatch(rf"kinalign {verb}: (.+: )?expected .+, found .+(\n  .*)*\n", err), said
        if out is not None:
            assert not pathlib.Path(out).exists(), "half a file: " + said
    elif done.returncode in (0, 1):
        assert err == "", "stderr of a success: " + said
        if "--json" in words:
            parsed(done.stdout.decode("utf-8"))
    return said


def refused(*words, naming, out=None, **how):
    """The call ends with exit code 3 and a line that begins with the file's name."""
    done = kinalign(*words, **how)
    said = law(done, words, out)
    assert done.returncode == 3, said
    first = done.stderr.decode("utf-8", "replace").splitlines()[0]
    assert first.startswith(f"kinalign {words[0]}: {naming}"), f"not {naming}: {said}"
    return first


def done_with(code, *words, **how):
    """What a call said that ends with this exit code, or one of these: stdout, stderr."""
    done = kinalign(*words, **how)
    said = law(done, words)
    assert done.returncode in (code if isinstance(code, tuple) else (code,)), said
    return done.stdout.decode(), done.stderr.decode()


def wrong(*words, says, **how):
    """Wrong use: exit code 2, and the first line."""
    _, err = done_with(2, *words, **how)
    first = err.splitlines()[0]
    assert first == f"kinalign {words[0]}: {says}", f"{first}\nnot {says}"


def nobody():
    """A prefix of calls that another user makes."""
    if os.geteuid() != 0:
        raise Skip("needs root to become another user")
    prefix = ("setpriv", "--reuid=65534", "--regid=65534", "--clear-groups")
    if subprocess.run([*prefix, "test", "-x", PROGRAM], check=False).returncode:
        raise Skip("needs a build folder that other users can enter")
    return prefix


def examples(verb):
    """The commands of a help page."""
    page, _ = done_with(0, verb, "--help")
    commands = [line.strip() for line in page.split(f"\n{verb}: ")[0].splitlines() if line.startswith("  kinalign ")]
    assert commands, page
    return commands


def typed(command, folder):
    """Such a command as somebody types it in a folder."""
    place = {"PATH": f"{PROGRAM.parent}:/usr/bin:/bin", "HOME": str(folder)}
    return subprocess.run(["bash", "-c", command], cwd=folder, env=place, capture_output=True, check=False, timeout=60)


def demo(folder, seconds=1, seed=1):
    subprocess.run([DEMO, folder, "--seed", str(seed), "--seconds", str(seconds)], check=True,
                   capture_output=True)
    return pathlib.Path(folder)


def main():
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    return run_cases("kinalign apps ", sys.argv[2:])
