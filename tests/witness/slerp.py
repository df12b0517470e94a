# SPDX-License-Identifier: Apache-2.0
"""SciPy's Slerp and RotationSpline."""
import numpy as np
from arrays import answer, given
from scipy.spatial.transform import Rotation, RotationSpline, Slerp

times, at = given("times"), given("at")
knots = Rotation.from_quat(given("knots", -1, 4)[:, [1, 2, 3, 0]])
answer("slerp", Slerp(times, knots)(at).as_quat()[:, [3, 0, 1, 2]])
spline = RotationSpline(times, knots)
answer("spline", spline(at).as_quat()[:, [3, 0, 1, 2]])
answer("rates", spline(times, 1))
