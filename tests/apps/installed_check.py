# SPDX-License-Identifier: Apache-2.0
"""What `cmake --install` puts into a prefix works from there, and what shells and man read of it.
installed_check.py BUILD_FOLDER [CASE...]"""
import json
import os
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import BUILD, Skip, case, demo, main

ROOT = pathlib.Path(__file__).resolve().parents[2]


def installed(folder):
    """A fresh prefix."""
    prefix = folder / "a prefix"
    subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, capture_output=True)
    return prefix


def run(*words, cwd):
    """As someone who has nothing but the prefix: another folder, no settings, no variables."""
    return subprocess.run([*map(str, words)], cwd=cwd, env={"PATH": os.defpath, "HOME": str(cwd)}, timeout=120,
                          stdin=subprocess.DEVNULL, capture_output=True, check=False)


def accepts(shell, *words):
    """The shell takes a script for a well-formed one."""
    program = shutil.which(shell)
    if program is None:
        raise Skip(f"no {shell} here")
    done = subprocess.run([program, *map(str, words)], capture_output=True, check=False)
    assert done.returncode == 0 and done.stderr == b"", f"{shell}: {done.stderr.decode()}"
    return done.stdout.decode()


@case
def a_prefix_aligns_a_recording_and_its_layouts_read_files(folder):
    prefix = installed(folder)
    program = prefix / "bin/kinalign"
    demo(folder / "demo", seconds=1)
    done = run(program, "align", folder / "demo/recording.toml", "-o", "take.h5", "--json", cwd=folder)
    assert done.returncode in (0, 1) and done.stderr == b"", done.stderr.decode()
    assert json.loads(done.stdout)["report"]["frames"] > 50
    layout = prefix / "share/kinalign/layouts/kinect.toml"
    words = ("align", "--mocap", folder / "demo/mocap.bvh", "--kinect", folder / "demo/kinect.csv")
    start = (folder / "demo/recording.toml").read_text().split("start_ns = ")[1].split()[0]
    done = run(program, *words, "--kinect-layout", layout, "--start-ns", start, "-o", "b.h5", cwd=folder)
    assert done.returncode in (0, 1) and done.stderr == b"", done.stderr.decode()
    done = run(program, "info", folder / "b.h5", cwd=folder)
    assert done.returncode == 0 and b"kinect.toml" in done.stdout, done.stdout.decode()


@case
def a_prefix_holds_every_layout_that_the_program_carries_and_no_other(folder):
    prefix = installed(folder)
    there = {p.name: p.read_bytes() for p in (prefix / "share/kinalign/layouts").iterdir()}
    assert there == {p.name: p.read_bytes() for p in (ROOT / "layouts").glob("*.toml")}
    (folder / "k.csv").write_text("x\n")
    done = run(prefix / "bin/kinalign", "info", "k.csv", "--layout", "none", cwd=folder)
    assert done.returncode == 3, done.stderr.decode()
    named = done.stderr.decode().split("one of ")[1].split(", found")[0].split(", ")
    assert {p.removesuffix(".toml") for p in there} <= set(named), named


@case
def a_prefix_says_the_version_that_its_takes_will_say(folder):
    done = run(installed(folder) / "bin/kinalign", "--version", cwd=folder)
    version = (ROOT / "CMakeLists.txt").read_text().split("VERSION ")[2].split()[0]
    assert done.stdout.decode() == f"kinalign {version}\n", done.stdout.decode()


@case
def bash_takes_its_completion(folder):
    accepts("bash", "-n", installed(folder) / "share/bash-completion/completions/kinalign")


@case
def zsh_takes_its_completion(folder):
    script = installed(folder) / "share/zsh/site-functions/_kinalign"
    accepts("zsh", "-n", script)
    assert script.read_text().startswith("#compdef kinalign\n")


@case
def fish_takes_its_completion_and_offers_the_verbs(folder):
    script = installed(folder) / "share/fish/vendor_completions.d/kinalign.fish"
    accepts("fish", "--no-execute", script)
    offered = accepts("fish", "--no-config", "-c", f"source '{script}'; complete -C 'kinalign '")
    verbs = {line.split("\t")[0] for line in offered.splitlines()}
    assert {"align", "check", "convert", "info", "rebuild"} <= verbs, offered


@case
def man_shows_the_page_without_a_warning(folder):
    page = installed(folder) / "share/man/man1/kinalign.1"
    text = accepts("man", "--warnings=all", "-E", "UTF-8", "-l", page)
    assert "kinalign" in text


@case
def a_plain_configure_needs_no_preset_and_builds_for_speed(folder):
    plain = folder / "plain"
    for words in (("-S", ROOT, "-B", plain, "-DKINALIGN_TESTS=OFF"), ("--build", plain, "--target", "kinalign_core")):
        done = subprocess.run(["cmake", *words], capture_output=True, check=False)
        assert done.returncode == 0, done.stderr.decode()
    assert (plain / "kinalign/core/libkinalign_core.a").exists()
    assert "CMAKE_BUILD_TYPE:STRING=Release\n" in (plain / "CMakeCache.txt").read_text()


if __name__ == "__main__":
    sys.exit(main())
