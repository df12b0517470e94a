# SPDX-License-Identifier: Apache-2.0
"""SciPy's Rotation.align_vectors about the means: the best rotation, and the rms it leaves."""
import numpy as np
from arrays import answer, given
from scipy.spatial.transform import Rotation

a, b = given("from", -1, 3), given("to", -1, 3)
rotation, _ = Rotation.align_vectors(b - b.mean(0), a - a.mean(0))
shift = b.mean(0) - rotation.apply(a.mean(0))
answer("rotation", rotation.as_quat()[[3, 0, 1, 2]])
answer("translation", shift)
answer("rms", np.sqrt(((rotation.apply(a) + shift - b) ** 2).sum(1).mean()))
