# SPDX-License-Identifier: Apache-2.0
"""The Kinect table as a tool: kinect_table_check.py KINALIGN_KINECT_TABLE
The rows that need no recordings are held by tests/tools/kinect_bands_test.cpp in each run."""
import importlib.util
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))
from run_cases import Skip, case, run_cases

TABLE = pathlib.Path(sys.argv[1]).resolve()


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


@case
def the_kinect_table_refuses_what_is_no_export(folder):
    code, text = run(TABLE)
    assert code == 2 and text.startswith("usage: kinalign_kinect_table PAIRS"), text
    (folder / "pairs.bin").write_bytes(b"KAPAIRS1\xff\xff\xff\xff")
    code, text = run(TABLE, folder / "pairs.bin")
    assert code == 3 and f"{folder / 'pairs.bin'}: expected " in text, text


@case
def every_band_of_the_simulated_Kinect_is_met_on_seeds_1_to_20(folder):
    if not os.environ.get("KINALIGN_LONG_TESTS"):
        raise Skip("a minute or two: with KINALIGN_LONG_TESTS=1")
    if not (ROOT / "../shared/data/ui_prmd").is_dir():
        raise Skip("needs ../shared/data, which is not there")
    if not importlib.util.find_spec("scipy"):
        raise Skip("no SciPy")
    code, text = run(sys.executable, ROOT / "tools/kinect_table/export_ui_prmd.py", folder / "pairs.bin")
    assert code == 0 and text == "620 repetitions, 45876 frames\n", text
    code, text = run(TABLE, folder / "pairs.bin", "--bars")
    assert code == 0 and text.endswith("\n86 of 86 bands met\n"), text


sys.exit(run_cases("kinalign kinect table "))
