# SPDX-License-Identifier: Apache-2.0
"""Stopped at any moment, the program leaves what was there and nothing else.
stop_check.py BUILD_FOLDER [CASE...]"""
import pathlib
import random
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
import samples
from cases import LONG, case, demo, kinalign, law, main

OLD = b"what stood there before"


def stopped_after(seconds, sign, words):
    """Starts, waits, sends the signal; exit code and stderr."""
    with subprocess.Popen([str(cases.PROGRAM), *map(str, words)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, stdin=subprocess.DEVNULL) as program:
        time.sleep(seconds)
        program.send_signal(sign)
        _, err = program.communicate(timeout=60)
        return program.returncode, err.decode()


def stop_often(folder, signs, check):
    """Every verb that writes, stopped at moments over its whole run."""
    recording = demo(folder / "d", seconds=40) / "recording.toml"
    out = folder / "o"
    out.mkdir()
    jobs = ((("align", recording, "-o"), "t.h5"),
            (("convert", folder / "d/mocap.bvh"), "t.npz"),
            (("convert", folder / "d/mocap.bvh"), "t.bvh"),
            (("convert", folder / "t.h5"), "t.npz"))
    assert kinalign("align", recording, "-o", folder / "t.h5").returncode == 0
    draw = random.Random(7)
    for words, name in jobs:
        begin = time.monotonic()
        done = kinalign(*words, out / name)
        length = time.monotonic() - begin
        assert done.returncode == 0, done.stderr
        whole = (out / name).read_bytes()
        for k in range(40 if LONG else 8):
            before = OLD if k % 2 else None
            (out / name).unlink(missing_ok=True)
            if before:
                (out / name).write_bytes(before)
            code, err = stopped_after(draw.uniform(0, length), signs[k // 2 % len(signs)], (*words, out / name, "--force"))
            left = {p.name: p.read_bytes() for p in out.iterdir()}
            check(code, err)
            now = left.pop(name, None)
            assert now == whole or (code != 0 and now == before), f"{name}: half a file, exit {code}"
            # Killed between link and rename: the new file, whole, beside the old one.
            between = before and code == -signal.SIGKILL and now == before and [*left.values()] == [whole]
            assert not left or between, f"stray files {list(left)}"
            for stray in left:
                (out / stray).unlink()
        (out / name).unlink(missing_ok=True)


@case
def a_kill_at_any_moment_leaves_the_old_file_or_the_new_one(folder):
    def check(code, _):
        assert code in (0, -signal.SIGKILL), code
    stop_often(folder, (signal.SIGKILL,), check)


@case
def an_interruption_at_any_moment_ends_with_130_and_no_half_file(folder):
    def check(code, err):
        if code in (-signal.SIGINT, -signal.SIGTERM, -signal.SIGHUP):  # before the program took the signal
            assert err == "", err
            return
        assert code in (0, 130), f"exit {code}: {err}"
        assert code == 0 or "no unfinished file is left" in err, err
    stop_often(folder, (signal.SIGINT, signal.SIGTERM, signal.SIGHUP), check)


@case
def an_interruption_half_way_ends_every_verb_with_130(folder):
    """Also in passes that only check or write what was surveyed before."""
    demo(folder / "d", seconds=300)
    bvh, take = folder / "d/mocap.bvh", folder / "t.h5"
    (folder / "cut.bvh").write_bytes(bvh.read_bytes()[:-200])
    for words in (("align", folder / "d/recording.toml", "-o", take, "--force"),
                  ("check", bvh), ("info", folder / "cut.bvh"),
                  ("convert", bvh, folder / "o.npz", "--force"),
                  ("convert", bvh, folder / "o.bvh", "--force")):
        begin = time.monotonic()
        assert kinalign(*words).returncode in (0, 1)
        length = time.monotonic() - begin
        codes = [stopped_after(part * length, signal.SIGINT, words)[0]
                 for part in (0.7, 0.6, 0.8, 0.5, 0.65, 0.75)]
        assert 130 in codes, f"{words[0]} {words[1].name}: {codes}"


class Changing:
    """A file that is changed while it is read, over and over."""

    def __init__(self, path, texts):
        script = ("import sys,time\npath=sys.argv[1]\ntexts=[open(p,'rb').read() for p in sys.argv[2:]]\n"
                  "k=0\nwhile True:\n  open(path,'r+b').truncate(len(texts[k]))\n"
                  "  open(path,'r+b').write(texts[k])\n  k=(k+1)%len(texts)\n  time.sleep(0.003)\n")
        names = []
        for k, text in enumerate(texts):
            names.append(f"{path}.{k}")
            pathlib.Path(names[-1]).write_bytes(text)
        self.writer = subprocess.Popen([sys.executable, "-c", script, path, *names])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.writer.kill()
        self.writer.wait()


@case
def a_file_that_changes_while_it_is_read_gives_no_crash_and_no_half_take(folder):
    recording = demo(folder / "d", seconds=4) / "recording.toml"
    draw = random.Random(3)
    for name in ("mocap.bvh", "kinect.csv", "imu_waist.csv"):
        path = folder / "d" / name
        whole = path.read_bytes()
        cut = whole[:draw.randrange(len(whole) // 4, len(whole))]
        longer = whole + whole[len(whole) // 2:]
        with Changing(path, (whole, cut, longer, b"")):
            for k in range(40 if LONG else 8):
                out = folder / f"t{k}.h5"
                words = ("align", recording, "-o", out) if k % 4 else ("convert", path, folder / "t.npz")
                done = kinalign(*words)
                law(done, words, words[-1])
                if out.exists():
                    assert kinalign("check", out).returncode in (0, 1)
                    out.unlink()
                (folder / "t.npz").unlink(missing_ok=True)
        path.write_bytes(whole)


@case
def two_at_once_on_one_name_leave_one_whole_take(folder):
    recording = samples.recording(folder)
    out = folder / "t.h5"
    for force in ((), ("--force",)):
        words = [str(cases.PROGRAM), "align", str(recording), "-o", str(out), *force]
        running = [subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                   for _ in range(6)]
        codes = []
        for one in running:
            one.communicate(timeout=60)
            codes.append(one.returncode)
        assert codes.count(0) == (1 if not force else 6), codes
        assert kinalign("check", out).returncode == 0
    assert sorted(p.name for p in folder.iterdir()) == ["imu.csv", "kinect.csv", "mocap.bvh",
                                                        "recording.toml", "t.h5"]


if __name__ == "__main__":
    sys.exit(main())
