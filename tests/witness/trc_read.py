# SPDX-License-Identifier: Apache-2.0
"""Reads FOLDER/written.trc as OpenSim's reader does and compares with positions.in [T,J,3] in metres, states.in [T,J].

OpenSim asks for the eight keys in their order, labels X1 Y1 Z1 ... and 3 J + 2 cells in each row; an empty cell is NaN.
"""
import sys

import numpy as np
from arrays import given

lines = open(f"{sys.argv[1]}/written.trc", newline="").read().split("\n")
assert lines.pop() == ""
assert lines[0].split("\t") == ["PathFileType", "4", "(X/Y/Z)", "written.trc"]
assert lines[1].split("\t") == ["DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units", "OrigDataRate",
                                "OrigDataStartFrame", "OrigNumFrames"]
facts = dict(zip(lines[1].split("\t"), lines[2].split("\t")))
markers, frames = int(facts["NumMarkers"]), int(facts["NumFrames"])
assert facts["Units"] == "mm" and float(facts["DataRate"]) == 120.0
names = [cell for cell in lines[3].split("\t") if cell]
assert names == ["Frame#", "Time", *[f"M{k}" for k in range(markers)]]
labels = [cell for cell in lines[4].split("\t") if cell]
assert labels == [f"{axis}{k}" for k in range(1, markers + 1) for axis in "XYZ"]
assert lines[5] == ""
rows = [line.split("\t") for line in lines[6:]]
assert len(rows) == frames and all(len(row) == 3 * markers + 2 for row in rows)
assert [int(row[0]) for row in rows] == list(range(1, frames + 1))
assert np.abs(np.array([float(row[1]) for row in rows]) - np.arange(frames) / 120).max() < 1e-9
read = np.array([[float(cell or "nan") for cell in row[2:]] for row in rows]).reshape(frames, markers, 3) / 1000
states = given("states", -1, markers)
assert (np.isnan(read).all(axis=-1) == (states == 0)).all()
assert np.nanmax(np.abs(read - given("positions", -1, markers, 3))) <= 5.1e-9
