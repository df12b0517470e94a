# SPDX-License-Identifier: Apache-2.0
"""SciPy's share of the table: natural spline, slerp and rotation spline, ns a value or rotation.

usage: scipy_resampling.py [ROUNDS=3]; prints one JSON object
"""
import json
import statistics
import sys
import time

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation, RotationSpline, Slerp

rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
rows, channels, knots = 30000, 75, 3000
random = np.random.default_rng(1)
times = np.arange(rows) / 30 + 0.004 * np.clip(random.standard_normal(rows), -3, 3)
values = random.standard_normal((rows, channels))
at = np.clip(np.arange(2 * rows - 1) / 60, times[0], times[-1])
rotations = Rotation.from_rotvec(np.cumsum(0.05 * random.standard_normal((rows, 3)), 0) % 1)
few, few_at = times[:knots], np.clip(at[: 2 * knots - 1], times[0], times[knots - 1])

jobs = {
    "spline/scipy": (lambda: CubicSpline(times, values, bc_type="natural")(at), len(at) * channels),
    "slerp/scipy": (lambda: Slerp(times, rotations)(at), len(at)),
    "rotation_spline/scipy": (lambda: RotationSpline(few, rotations[:knots])(few_at), len(few_at)),
}
seconds = {name: [] for name in jobs}
for _ in range(rounds):
    for name, (job, _) in jobs.items():
        begin = time.perf_counter()
        job()
        seconds[name].append(time.perf_counter() - begin)
print(json.dumps({n: 1e9 * statistics.median(seconds[n]) / jobs[n][1] for n in jobs}))
