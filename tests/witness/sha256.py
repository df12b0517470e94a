# SPDX-License-Identifier: Apache-2.0
"""Beside each file NAME of the folder, NAME.sha256 with hashlib's digest."""
import hashlib
import pathlib
import sys

for path in list(pathlib.Path(sys.argv[1]).iterdir()):
    path.with_name(path.name + ".sha256").write_text(hashlib.sha256(path.read_bytes()).hexdigest())
