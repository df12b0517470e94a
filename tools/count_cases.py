# SPDX-License-Identifier: Apache-2.0
"""Counts test cases: count_cases.py CASES_LOG CTEST_LOG FAILED_ELSEWHERE

CASES_LOG has a line a case (see tests/main.cpp); CTEST_LOG is ctest's output, for programs that
ended before they could say; FAILED_ELSEWHERE is 1 where a check or ctest failed. The last line is
exactly "N passed, N failed, N skipped"; the exit code is 1 where anything failed.
"""
import collections
import pathlib
import re
import sys


def lines_of(name):
    path = pathlib.Path(name)
    return path.read_text(errors="replace").splitlines() if path.exists() else []


def main():
    cases_log, ctest_log, elsewhere = sys.argv[1:4]
    cases = collections.defaultdict(list)
    for line in lines_of(cases_log):
        outcome, _, name = line.partition("\t")
        cases[outcome].append(name)
    for line in lines_of(ctest_log):  # a crash, a timeout: no case said that it failed
        broken = re.match(r"\s*\d+ - (\S+) \((SEGFAULT|Subprocess|Timeout|Not Run|ILLEGAL|SIG)", line)
        if broken:
            cases["failed"].append(f"the program of {broken[1]} ended early or did not run")
    for line in lines_of(ctest_log) if not cases["failed"] else []:  # a sanitizer ends with 1
        broken = re.match(r"\s*\d+ - (\S+) \(Failed\)", line)
        if broken:
            cases["failed"].append(f"the program of {broken[1]} failed outside its cases")
    if elsewhere == "1" and not cases["failed"]:
        print("failed outside the test cases: see above")
    for name in cases["failed"]:
        print(f"failed: {name}")
    for name in cases["late"]:
        print(f"late, run again: {name}")
    reasons = collections.defaultdict(list)
    for name in cases["skipped"]:
        text, _, reason = name.partition("\t")
        reasons[reason or "needs ../shared/data, which is not there"].append(text)
    for reason, names in sorted(reasons.items()):
        print(f"skipped, {reason}:")
        for name in names:
            print(f"  {name}")
    print(f"{len(cases['passed'])} passed, {len(cases['failed'])} failed, {len(cases['skipped'])} skipped")
    return 1 if cases["failed"] or elsewhere == "1" else 0


sys.exit(main())
