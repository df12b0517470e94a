# SPDX-License-Identifier: Apache-2.0
"""Small data sets for cases, made by the program itself."""
import hashlib
import json
import pathlib
import subprocess

from cases import DEMO, Skip, kinalign, law

SHARED = pathlib.Path(__file__).resolve().parents[3] / "shared/data"


def shared(name):
    if not (SHARED / name).exists():
        raise Skip(f"no ../shared/data/{name}")
    return SHARED / name


def done(*words, code=0, **how):
    """A call that ends with this code, None for any that is no failure; its stdout, or its stderr where it failed."""
    ran = kinalign("dataset", *words, **how)
    said = law(ran, ("dataset", *words))
    assert ran.returncode == code or (code is None and ran.returncode < 2), said
    return (ran.stdout if ran.returncode < 2 else ran.stderr).decode()


def answer(*words, **how):
    return json.loads(done(*words, "--json", **how))


def recorded(folder, seconds, takes=1, seed=1):
    """Manifests of raw files."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run([DEMO, folder, "--seconds", f"{seconds:.9f}", "--takes", str(takes), "--seed", str(seed)], check=True)
    return sorted(folder.rglob("recording.toml"))


def small_set(folder, takes=3, seconds=3):
    """A data set of some takes, not built yet."""
    done("init", folder / "set", "--template", "hfut-mmd")
    for i in range(takes):  # of lengths that differ, so that no raw files are alike
        manifest, = recorded(folder / "raw" / f"{i}", seconds + i / 60, seed=i + 1)
        done("add", folder / "set", manifest, "--subject", f"{i % 12:02}", "--action", f"S2A{i % 8 + 1:02}")
    return folder / "set"


def contents(folder):
    """Hash of every file, but for the cache."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
            for p in sorted(folder.rglob("*")) if p.is_file() and ".kinalign" not in p.parts}


def takes(data):
    return sorted(p.name.removesuffix("_recording.toml") for p in data.glob("sub-*/*_recording.toml"))


def small_bvh(folder, *names):
    """One short BVH under many names."""
    subprocess.run([DEMO, folder / "demo", "--seconds", "1", "--seed", "1"], check=True, capture_output=True)
    bvh, = (folder / "demo").rglob("*.bvh")
    for i, name in enumerate(names):
        path = folder / "source" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(bvh.read_text() + "\n" * i)
    return folder / "source"
