# SPDX-License-Identifier: Apache-2.0
"""Cases in Python, counted like the others: a function whose name is a sentence, a fresh folder."""
import os
import pathlib
import subprocess
import tempfile

CASES = []


class Skip(Exception):
    """Raised by a case that can't run here, with the reason."""


def case(function):
    CASES.append(function)
    return function


def run_cases(prefix, wanted=()):
    """Runs all cases, or the wanted ones; 1 where one failed."""
    log = os.environ.get("KINALIGN_TEST_LOG")
    failed = False
    for one in CASES:
        name = one.__name__.replace("_", " ")
        if wanted and one.__name__ not in wanted:
            continue
        with tempfile.TemporaryDirectory(prefix=prefix) as folder:
            try:
                one(pathlib.Path(folder))
                outcome = "passed"
            except Skip as reason:
                outcome, name = "skipped", f"{name}\t{reason}"
            except (AssertionError, subprocess.SubprocessError, OSError) as error:
                outcome = "failed"
                failed = True
                print(f"{name}: {error}")
        if log:
            with open(log, "a", encoding="utf-8") as out:
                out.write(f"{outcome}\t{name}\n")
    return 1 if failed else 0
