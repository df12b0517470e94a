# SPDX-License-Identifier: Apache-2.0
"""Opens a file beyond 4 GB of tests/formats/take/take_npz_test.cpp."""
import sys
import zipfile

import numpy as np

with zipfile.ZipFile(sys.argv[1]) as archive:
    sizes = {one.filename: one.file_size for one in archive.infolist()}
    assert sizes["a.npy"] == 65_537 * 65_536 + 128, sizes
    with archive.open("a.npy") as member:
        assert np.lib.format.read_magic(member) == (1, 0)
        assert np.lib.format.read_array_header_1_0(member)[0] == (65_537, 65_536)
assert np.load(sys.argv[1])["b"].tolist() == [7, -9]
