# SPDX-License-Identifier: Apache-2.0
"""Calls of `kinalign dataset`, and raw files for a data set."""
import hashlib
import json
import subprocess

from cases import DEMO, kinalign, law


def done(*words, code=0, **how):
    """A call that ends with this code; its stdout."""
    ran = kinalign("dataset", *words, **how)
    said = law(ran, ("dataset", *words))
    assert ran.returncode == code, said
    return ran.stdout.decode()


def answer(*words, **how):
    return json.loads(done(*words, "--json", **how))


def recorded(folder, seconds, takes=1, seed=1):
    """Manifests of raw files."""
    subprocess.run([DEMO, folder, "--seconds", f"{seconds:.9f}", "--takes", str(takes), "--seed", str(seed)], check=True)
    return sorted(folder.rglob("recording.toml"))


def contents(folder):
    """Hash of every file, but for the cache."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in sorted(folder.rglob("*")) if p.is_file() and ".kinalign" not in p.parts}
