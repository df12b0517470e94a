# SPDX-License-Identifier: Apache-2.0
"""Cases in Python, counted like the others: a function whose name is a sentence, a fresh folder."""
import os
import pathlib
import subprocess
import tempfile

CASES = []


class Skip(Exception):
    """Raised by a case that can't run here, with the reason."""


class Late(Exception):
    """Raised by a case for what took longer than it does: it is run again, three times in all. A machine
    that is lent by the millisecond stands still for tens of them now and then."""


def in_time(holds, *said):
    """For what depends on the machine beside the program, never for what has to hold however long it takes."""
    if not holds:
        raise Late(*said)


def case(function):
    CASES.append(function)
    return function


def tell(outcome, name):
    """A line of the log that tools/count_cases.py reads."""
    if log := os.environ.get("KINALIGN_TEST_LOG"):
        with open(log, "a", encoding="utf-8") as out:
            out.write(f"{outcome}\t{name}\n")


def run_case(one, prefix):
    for tries_left in (2, 1, 0):
        with tempfile.TemporaryDirectory(prefix=prefix) as folder:
            try:
                return one(pathlib.Path(folder))
            except Late as why:
                assert tries_left, f"late three times: {why}"
                tell("late", f"{one.__name__.replace('_', ' ')}: {why}".replace("\n", " "))


def run_cases(prefix, wanted=()):
    """Runs all cases, or the wanted ones; 1 where one failed."""
    failed = False
    for one in CASES:
        name = one.__name__.replace("_", " ")
        if wanted and one.__name__ not in wanted:
            continue
        try:
            run_case(one, prefix)
            outcome = "passed"
        except Skip as reason:
            outcome, name = "skipped", f"{name}\t{reason}"
        except (AssertionError, subprocess.SubprocessError, OSError) as error:
            outcome = "failed"
            failed = True
            print(f"{name}: {error}")
        tell(outcome, name)
    return 1 if failed else 0
