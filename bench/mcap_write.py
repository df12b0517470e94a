# SPDX-License-Identifier: Apache-2.0
"""Messages a second into an MCAP file, ours and @mcap/core's by turns in one run: raw payloads of a lab,
uncompressed, chunks of 1 MiB, checksums and index.  mcap_write.py BUILD NODE_MODULES [--messages N] [--runs 5]"""
import argparse
import pathlib
import statistics
import subprocess
import sys
import tempfile

PEER = pathlib.Path(__file__).parent / "peers/mcap_write.mjs"


def seconds(*words):
    return float(subprocess.run([*map(str, words)], check=True, capture_output=True, text=True).stdout)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("node_modules", type=pathlib.Path)
    parser.add_argument("--messages", type=int, default=400_000)
    parser.add_argument("--runs", type=int, default=5)
    o = parser.parse_args()
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as folder:
        for k in range(o.runs):
            ours.append(seconds(o.build / "bench/mcap_write", f"{folder}/ours{k}.mcap", o.messages))
            theirs.append(seconds("node", PEER, o.node_modules.resolve(), f"{folder}/theirs{k}.mcap", o.messages))
            for file in pathlib.Path(folder).iterdir():
                file.unlink()
    rates = [o.messages / statistics.median(times) for times in (ours, theirs)]
    print(f"kinalign {rates[0]:,.0f} messages/s, @mcap/core {rates[1]:,.0f}: {rates[0] / rates[1]:.1f} times "
          f"(medians of {o.runs}; {min(o.messages / s for s in ours):,.0f} to {max(o.messages / s for s in ours):,.0f}, "
          f"{min(o.messages / s for s in theirs):,.0f} to {max(o.messages / s for s in theirs):,.0f})")
    return 0 if rates[0] >= 10 * rates[1] else 1


if __name__ == "__main__":
    sys.exit(main())
