# SPDX-License-Identifier: Apache-2.0
"""The protocol's own metrics of one repetition, and a fold's row of it twice: ../shared/tools/ui_prmd_marks.py."""
import pathlib
import sys

from arrays import answer, given
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "../shared/tools"))
import ui_prmd_marks as marks

lengths = given("lengths")
piece = {"y": 100 * given("truth", -1, 18, 3), "w": given("valid", -1, 18) > 0,
         "L": np.where(lengths > 0, 100 * lengths, np.nan)}
found = marks.metrics(piece, 100 * given("prediction", -1, 18, 3))
answer("marks", [found[k] for k in ("MPJPE", "PA", "BONE", "CONST", "ACC", "jp", "jt")])
answer("row", marks.fold_mean([found, {**found, "jp": 2 * found["jp"]}]))
