# SPDX-License-Identifier: Apache-2.0
"""What recording a lab costs: five nodes at 100 frames/s, mocap at 125 (354 floats), a Kinect at 30, all
`--times` as fast, into the real program on loopback.
  record_load.py BUILD                               a minute at the speed of the lab
  record_load.py BUILD --times 20 --minutes 480      eight hours' worth in 24 minutes, some 7 GB
  record_load.py BUILD --flood 50000                 while strangers flood the mocap's port"""
import argparse
import pathlib
import statistics
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests"))
from record_runs import Recorder, lost


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--times", type=float, default=1.0)
    parser.add_argument("--minutes", type=float, default=1.0, help="of the lab's time")
    parser.add_argument("--folder", help="where the recording goes; removed again (default: the system's)")
    parser.add_argument("--flood", type=int, default=0, help="datagrams a second from 10,000 addresses")
    o = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=o.folder) as folder:
        recorder = Recorder(o.build.resolve(), pathlib.Path(folder) / "take")
        seconds = 60.0 * o.minutes / o.times
        flood = recorder.flood(o.flood, seconds) if o.flood else None
        sent = recorder.load(o.times, seconds)
        if flood:
            flood.wait()
        recorded = recorder.end()
        size = recorder.path.stat().st_size
    gone = lost(sent, recorded)
    if o.flood:
        del gone["mocap"]  # the flooded one
    messages = sent["mocap"] + sent["kinect"] + sum(sent["nodes"])
    settled = [mb for s, mb, _ in recorder.samples if s > 60.0 / o.times and s < recorder.load_s - 1]
    files = [count for _, _, count in recorder.samples]
    print(f"{messages:,} messages in {recorder.load_s:.0f} s, {messages / recorder.load_s:,.0f} a second, "
          f"{size / 1e6:,.0f} MB")
    print(f"lost: {sum(gone.values())}" + (f" ({gone})" if any(gone.values()) else ""))
    print(f"processor: {100 * recorder.cpu_s / recorder.load_s:.2f} % of one core")
    if settled:
        quarter = max(1, len(settled) // 4)
        begin, end = (statistics.median(part) for part in (settled[:quarter], settled[-quarter:]))
        print(f"memory after the first minute's worth: {begin:.1f} MB in its first quarter, {end:.1f} MB in its last "
              f"(medians; {min(settled):.1f} to {max(settled):.1f})")
    else:
        print(f"memory: at most {max(mb for _, mb, _ in recorder.samples):.1f} MB")
    print(f"open files: {min(files)} to {max(files)}")
    print("reply after (half, 99 %, all), ms: " + ", ".join(f"{ms:.2f}" for ms in sent["wait_ms"]))
    return 1 if any(gone.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
