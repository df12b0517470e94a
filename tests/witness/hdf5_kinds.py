# SPDX-License-Identifier: Apache-2.0
"""HDF5 files of other programs: a folder gets one for each range of library versions."""
import pathlib
import sys

import h5py

folder = pathlib.Path(sys.argv[1])
for libver in ("earliest", "v108", "v110", "latest"):
    with h5py.File(folder / f"{libver}.h5", "w", libver=libver) as file:
        file.attrs["format"] = 3
        file["time_ns"] = list(range(100))
