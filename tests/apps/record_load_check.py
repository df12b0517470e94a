# SPDX-License-Identifier: Apache-2.0
"""A lab at twenty times its speed, and with a flooded port: nothing that was sent is missing.
record_load_check.py BUILD_FOLDER [CASE...]"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import BUILD, SANITIZED, case, in_time, kinalign, main
from record_runs import Recorder, lost

# The bar is ten minutes' worth here, eight hours' once by bench/record_load.py.
TIMES, MINUTES = (2, 1) if SANITIZED else (20, 10)


@case
def a_lab_at_twenty_times_its_speed_loses_no_message(folder):
    recorder = Recorder(BUILD, folder / "take")
    sent = recorder.load(TIMES, 60 * MINUTES / TIMES)
    recorded = recorder.end()
    checked = kinalign("check", recorder.path)
    gone = lost(sent, recorded)
    # A machine that stands still longer than the kernel's buffer holds loses datagrams before we see any.
    in_time(not any(gone.values()), gone, sent)
    assert sent["mocap"] == 125 * 60 * MINUTES and min(sent["nodes"]) == 100 * 60 * MINUTES, sent
    assert checked.returncode == 0, checked.stdout
    assert recorder.info["closed"] is True, recorder.info
    counts = [files for _, _, files in recorder.samples]
    assert max(counts) == min(counts), counts
    # After the first minute's worth: flat within 1 MiB either way, which a leak of 8 bytes a message leaves five times
    # over. Only where the disk stands still for a second or more what waits for it makes it grow, once.
    settled = [mb for s, mb, _ in recorder.samples if s > 60 / TIMES]
    assert SANITIZED or max(settled) < 100, settled
    in_time(SANITIZED or max(settled) - min(settled) <= 2, settled)


@case
def strangers_that_flood_the_mocap_port_cost_the_other_devices_nothing(folder):
    recorder = Recorder(BUILD, folder / "take")
    flood = recorder.flood(2000 if SANITIZED else 20_000, 6)
    sent = recorder.load(1, 5)
    assert flood.wait(60) == 0
    gone = lost(sent, recorder.end())
    del gone["mocap"]
    in_time(not any(gone.values()), gone, sent)
    in_time(sent["replies"] > 0 and sent["wait_ms"][1] < 50, sent)  # 99 of 100 replies


if __name__ == "__main__":
    sys.exit(main())
