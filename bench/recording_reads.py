# SPDX-License-Identifier: Apache-2.0
"""How many bytes of a recording the program reads, over the file's size, counted by strace.

Usage: recording_reads.py KINALIGN RECORDING.mcap [MANIFEST.toml]
e.g.   bench/recording_reads.py build/release/apps/kinalign/kinalign demo/live/take_01.mcap demo/live/recording.toml
Prints a row for each verb. The limits of docs/performance_recording.md: align 3.2, the others 2.2; exit code 1 above them.
"""
import os
import re
import subprocess
import sys
import tempfile

CALL = re.compile(r"(\d+)\s+(\w+)\(\d+<([^>]*)>.*?(?:= (-?\d+)|<unfinished)")
RESUMED = re.compile(r"(\d+)\s+<\.\.\. (\w+) resumed>.*= (-?\d+)")


def bytes_read(recording, command):
    """Bytes of `recording` that the command reads, in how many calls; and its exit code."""
    target, total, calls, open_calls = os.path.realpath(recording), 0, 0, set()
    with tempfile.NamedTemporaryFile("r", errors="replace") as log:
        done = subprocess.run(
            ["strace", "-f", "-yy", "-e", "trace=read,pread64,readv,preadv,preadv2", "-o", log.name, *command],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        for line in log:
            call, resumed = CALL.match(line), RESUMED.match(line)
            if call and call[3] == target and call[4] is None:
                open_calls.add((call[1], call[2]))
            elif call and call[3] == target:
                total, calls = total + max(0, int(call[4])), calls + 1
            elif resumed and (resumed[1], resumed[2]) in open_calls:
                open_calls.remove((resumed[1], resumed[2]))
                total, calls = total + max(0, int(resumed[3])), calls + 1
    return total, calls, done.returncode


def main():
    program, recording, *manifest = sys.argv[1:]
    size, too_many = os.path.getsize(recording), 0
    print(f"{recording}: {size} bytes\n| verb | read, times the file | calls | limit |\n| --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for file in [recording, *manifest]:
            for verb, further, limit in (("align", ["-o", f"{folder}/take.h5", "--force"], 3.2), ("check", [], 2.2),
                                         ("info", [], 2.2), ("convert", [f"{folder}/shown.mcap", "--force"], 2.2)):
                if verb == "convert" and file.endswith(".toml"):
                    continue
                total, calls, code = bytes_read(recording, [program, verb, file, *further])
                if code > 1:
                    sys.exit(f"{verb} {file}: exit code {code}")
                too_many += total > limit * size
                print(f"| {verb} {os.path.basename(file)} | {total / size:.2f} | {calls} | {limit} |")
    return 1 if too_many else 0


sys.exit(main())
