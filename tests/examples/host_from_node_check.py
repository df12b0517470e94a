# SPDX-License-Identifier: Apache-2.0
"""The example of docs/how-to-time-own-device.md on input that is wrong: host_from_node_check.py EXAMPLE"""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from run_cases import case, run_cases

FRAMES = "1000000 50001400000\n1066667 50068000000 1003000 50001600000\n"


def run(text):
    done = subprocess.run([sys.argv[1]], input=text, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


@case
def frames_with_and_without_an_echo_are_taken(_):
    code, out, err = run(FRAMES)
    assert (code, err) == (0, "") and out.startswith("1066667 us: sent at 50066633500 ns"), (code, out, err)


@case
def a_line_that_is_no_frame_is_named_and_ends_it(_):
    for wrong in ("", "1066667", "1 2 3", "1 2 3 4 5", "1 2 x", "n_tx h_rx", "1 2.5", "1,2"):
        code, out, err = run(FRAMES + wrong + "\n" + FRAMES)
        assert code == 3 and err == f"line 3: expected two or four whole numbers, found {wrong}\n", (wrong, code, err)
        assert len(out.splitlines()) == 1, out


sys.exit(run_cases("kinalign examples ", sys.argv[2:]))
