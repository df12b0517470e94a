# SPDX-License-Identifier: Apache-2.0
"""Each NAME.npz of a folder holds, for numpy, just the arrays of NAME.txt (a line each: array, dtype, shape)
with the bytes of NAME.ARRAY.bin."""
import pathlib
import sys

import numpy as np

folder = pathlib.Path(sys.argv[1])
for listed in sorted(folder.glob("*.txt")):
    arrays = np.load(listed.with_suffix(".npz"), allow_pickle=False)
    lines = [line.split() for line in listed.read_text().splitlines()]
    assert list(arrays) == [line[0] for line in lines], (listed.name, list(arrays))
    for name, dtype, *shape in lines:
        array = arrays[name]
        assert array.dtype.str == dtype and array.shape == tuple(map(int, shape)), (listed.name, name, array.shape)
        assert array.tobytes() == (folder / f"{listed.stem}.{name}.bin").read_bytes(), (listed.name, name)
