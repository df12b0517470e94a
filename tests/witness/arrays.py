# SPDX-License-Identifier: Apache-2.0
"""Named arrays from and for tests/witness.h: little-endian doubles in the folder of argv[1]."""
import sys

import numpy as np


def given(name, *shape):
    return np.fromfile(f"{sys.argv[1]}/{name}.in", "<f8").reshape(shape or (-1,))


def answer(name, array):
    np.asarray(array, "<f8").tofile(f"{sys.argv[1]}/{name}.out")
