# SPDX-License-Identifier: Apache-2.0
"""SciPy's line through `values` over `times` by the Huber loss, quadratic up to 0.1 ms: its value at the first time and
its slope, for tests/formats/xdf/clock_test.cpp."""
import numpy as np
from scipy.optimize import least_squares

from arrays import answer, given

times, values = given("times"), given("values")
length = times[-1] - times[0]
x = (times - times[0]) / length
# In tenths of a millisecond, where the loss bends at 1.
start = np.polyfit(x, values, 1)[::-1] * 1e4
fit = least_squares(lambda p: p[0] + p[1] * x - values * 1e4, start, loss="huber", f_scale=1.0, method="trf",
                    xtol=1e-15, ftol=1e-15, gtol=1e-12, max_nfev=10000)
answer("line", [fit.x[0] * 1e-4, fit.x[1] * 1e-4 / length])
