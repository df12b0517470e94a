# SPDX-License-Identifier: Apache-2.0
"""Reads FOLDER/angles.mot and compares it with rotations.in [T,J,4], parents.in [J] and root.in [T,3], by SciPy's
rotations."""
import sys

import numpy as np
from arrays import given
from scipy.spatial.transform import Rotation


def table(name):
    lines = open(f"{sys.argv[1]}/{name}").read().splitlines()
    end = lines.index("endheader")
    facts = dict(line.split("=") for line in lines[1:end])
    names = lines[end + 1].split("\t")
    rows = np.array([[float(cell) for cell in line.split("\t")] for line in lines[end + 2:]])
    assert rows.shape == (int(facts["nRows"]), int(facts["nColumns"])) and len(names) == rows.shape[1]
    return lines[0], facts["inDegrees"], {name: rows[:, c] for c, name in enumerate(names)}


parents = given("parents").astype(int)
joints = len(parents)
truth = given("rotations", -1, joints, 4)
kind, degrees, angles = table("angles.mot")
assert (kind, degrees) == ("Coordinates", "yes")
frames = len(truth)
assert np.abs(angles["time"] - 0.01 * np.arange(frames)).max() < 1e-12

for j in range(joints):
    columns = [angles[f"J{j}_r{axis}"] for axis in "zxy"]
    local = Rotation.from_euler("ZXY", np.stack(columns, axis=-1), degrees=True)
    off = local.inv() * Rotation.from_quat(np.roll(truth[:, j], -1, axis=-1))
    assert off.magnitude().max() < 5e-8, (j, off.magnitude().max())
    if parents[j] < 0:
        placed = np.stack([angles[f"J{j}_t{axis}"] for axis in "xyz"], axis=-1)
        assert np.abs(placed - given("root", -1, 3)).max() < 1e-6
    else:
        assert f"J{j}_tx" not in angles
