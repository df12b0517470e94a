# SPDX-License-Identifier: Apache-2.0
"""A long recording needs no more memory than a short one: an hour has 256 MiB, these have half.
memory_check.py BUILD_FOLDER [CASE...]"""
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import PROGRAM, SANITIZED, Skip, case, demo, main

MIB = 1 << 20


def peak(*words, cwd):
    """The largest resident memory of a call, bytes."""
    with open(os.devnull, "w", encoding="utf-8") as nothing:
        child = subprocess.Popen([PROGRAM, *map(str, words)], cwd=cwd, stdin=subprocess.DEVNULL, stdout=nothing,
                                 stderr=nothing)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode in (0, 1), f"{words[0]} ended with {child.returncode}"
    return used.ru_maxrss * 1024


@case
def three_times_as_long_a_recording_takes_no_more_memory(folder):
    if SANITIZED:
        raise Skip("a sanitizer's memory is its own")
    peaks = {}
    for minutes in (5, 15):
        place = folder / str(minutes)
        place.mkdir()
        demo(place, seconds=60 * minutes)
        for what, words in (("align", ("align", "recording.toml", "-o", "t.h5")),
                            ("info", ("info", "t.h5")), ("check", ("check", "recording.toml")),
                            ("take to NPZ", ("convert", "t.h5", "t.npz")),
                            ("BVH to BVH", ("convert", "mocap.bvh", "b.bvh")),
                            ("rebuild", ("rebuild", "t.h5", "--inputs", ".", "--verify"))):
            used = peak(*words, cwd=place)
            assert used < 128 * MIB, f"{what} of {minutes} minutes: {used / MIB:.0f} MiB"
            assert used < peaks.get(what, used) + 24 * MIB, \
                f"{what}: {used / MIB:.0f} MiB of {minutes} minutes, {peaks[what] / MIB:.0f} of a third of it"
            peaks[what] = used
    assert (folder / "15/mocap.bvh").stat().st_size > 128 * MIB, "the file would fit"


if __name__ == "__main__":
    sys.exit(main())
