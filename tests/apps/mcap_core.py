# SPDX-License-Identifier: Apache-2.0
"""npm's @mcap/core as a witness (tests/witness/mcap_core.mjs)."""
import json
import os
import pathlib
import shutil
import subprocess

from run_cases import Skip

ROOT = pathlib.Path(__file__).parents[2]
MODULES = pathlib.Path(os.environ.get("KINALIGN_NODE_MODULES", ROOT / "build/npm/node_modules"))


def core(how, path, *cuts):
    """A dictionary for each cut."""
    if not shutil.which("node"):
        raise Skip("no node")
    if not (MODULES / "@mcap/core").is_dir():
        raise Skip(f"no @mcap/core in {MODULES}")
    done = subprocess.run(["node", ROOT / "tests/witness/mcap_core.mjs", MODULES, how, path, *map(str, cuts)],
                          text=True, capture_output=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]
