# SPDX-License-Identifier: Apache-2.0
"""Steps that no certificate sees: clock_steps_check.py KINALIGN_CLOCK_STEPS

A linear program is the witness (SciPy): of a recording that keeps a wrong certified stamp all is
explained by a clock that never stepped. Seeds were chosen once: a live clock looks at what it
remembers, once in ten seconds, and may miss what the program sees.
"""
import pathlib
import subprocess
import sys

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tools/clock_steps")]
from run_cases import case, run_cases
from steps import judged, least_violation

STEPS = pathlib.Path(sys.argv[1]).resolve()


def recording(offset):
    """Three minutes of packets each way that take 2 ms, some a little longer; x(t) is given."""
    random = numpy.random.default_rng(1)
    t = numpy.arange(0.0, 180.0, 0.1)
    up = numpy.stack([t, t + offset(t) + 2e-3 + random.exponential(1e-3, t.size)], axis=1)
    down = numpy.stack([t, t + offset(t) - 2e-3 - random.exponential(1e-3, t.size)], axis=1)
    return up, down


@case
def the_witness_explains_clocks_within_the_assumptions_up_to_their_edge(folder):
    assert least_violation(*recording(lambda t: 95e-6 * t)) <= 0.0
    assert least_violation(*recording(lambda t: 4.9e-8 * (t - 90.0) ** 2 / 2)) <= 0.0


@case
def and_none_too_fast_or_bent_too_much_or_stepped_by_more_than_both_delays(folder):
    assert least_violation(*recording(lambda t: 200e-6 * t)) > 1e-3
    assert least_violation(*recording(lambda t: 5e-6 * (t - 90.0) ** 2 / 2)) > 1e-3
    assert least_violation(*recording(lambda t: 6e-3 * (t > 90.0))) > 1e-4
    assert least_violation(*recording(lambda t: 3e-3 * (t > 90.0))) <= 0.0


@case
def a_recording_that_keeps_a_wrong_stamp_could_be_of_a_clock_that_never_stepped(folder):
    told = list(judged(STEPS, 1, 100, 3300, "DEG", [1.0, 1.1, 1.25, 1.5]))
    wrong = [one for one in told if "violation" in one]
    assert sum("runs" in one for one in told) == 12
    assert 1 <= len(wrong) <= 24, wrong
    assert all(one["violation"] <= 0.0 for one in wrong), wrong
    assert all(one["times"] < 1.5 for one in wrong), wrong


@case
def words_that_are_not_understood_are_refused(folder):
    for words in ((), ("1", "2", "3", "Z", "1"), ("1", "2", "3", "A"), ("1", "x", "3", "A", "1")):
        done = subprocess.run([STEPS, *words], capture_output=True, text=True, check=False)
        assert done.returncode == 2 and "usage" in done.stderr, words


@case
def a_program_that_is_not_built_is_named_with_what_builds_it(folder):
    script = ROOT / "tools/clock_steps/steps.py"
    done = subprocess.run([sys.executable, script, folder / "kinalign_clock_steps"], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 1 and done.stdout == "", done
    assert done.stderr == (
        f"steps.py: {folder}/kinalign_clock_steps: expected kinalign_clock_steps, found no such program\n"
        "  ./dev build makes it, as build/dev/tools/kinalign_clock_steps\n"), done


sys.exit(run_cases("kinalign clock steps ", sys.argv[2:]))
