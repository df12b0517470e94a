# SPDX-License-Identifier: Apache-2.0
"""Several processes that train one model. processes_check.py BUILD_FOLDER [CASE...]"""
import json
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import time

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import data_sets
from cases import BUILD, PROGRAM, Skip, case, kinalign, main, wrong
from posed import cmu_people

LEARN = BUILD / "apps/kinalign-learn/kinalign-learn"


def needs_gloo():
    if not LEARN.exists():
        raise Skip("kinalign-learn was not built: it needs libtorch-dev")
    if b"ProcessGroupGloo" not in LEARN.read_bytes():
        raise Skip("kinalign-learn was built without Gloo: it needs libgloo-dev")


def words_of(method, data, out, *more):
    return ("train", method, *data, "-o", out, "--steps", "20", "--jobs", "1", *more)


def trained(method, data, out, *more, env=None):
    ran = kinalign(*words_of(method, data, out, *more), memory=1 << 36, seconds=300, env=env)
    assert ran.returncode == 0, ran.stderr
    return out


def header_and_weights(path):
    data = path.read_bytes()
    end = 8 + struct.unpack("<Q", data[:8])[0]
    header = json.loads(data[8:end])
    model = json.loads(header.pop("__metadata__")["kinalign"])
    return model, {name: numpy.frombuffer(data[end:][slice(*one["data_offsets"])], "<f4") for name, one in header.items()}


def differences(a, b):
    a, b = header_and_weights(a)[1], header_and_weights(b)[1]
    assert a.keys() == b.keys()
    return numpy.concatenate([numpy.abs(a[name] - b[name]) for name in a])


def difference(a, b):
    return differences(a, b).max()


def people(folder):
    needs_gloo()
    return "--data", cmu_people(folder)


def pairs(folder):
    """A Kinect and a suit."""
    needs_gloo()
    data = data_sets.small_set(folder, takes=1)
    data_sets.done("build", data)
    return "--data", data


def check_same(folder, method, data, processes=2, others=0.0):
    """`others`: the share of weights that may differ by more than 1e-4."""
    one, two = (folder / f"{method}{n}.safetensors" for n in (1, processes))
    for n, model in ((1, one), (processes, two)):
        if not model.exists():
            trained(method, data, model, "--processes", n)
    off = (differences(one, two) >= 1e-4).mean()
    assert off <= others and difference(one, two) < 1e-3, (method, off, difference(one, two))
    logs = [path.with_suffix("").with_suffix(".training") / "log.csv" for path in (one, two)]
    last = [[float(x) for x in log.read_text().splitlines()[-1].split(",")[:4]] for log in logs]
    assert numpy.allclose(*last, rtol=1e-3), last
    assert header_and_weights(one)[0]["training"] == header_and_weights(two)[0]["training"]
    rest = {path.name for path in logs[1].parent.iterdir()}
    assert rest == {"curves.svg", "events.out.tfevents.0.kinalign", "job.json", "lock", "log.csv"}, rest


@case
def methods_that_clean_get_the_same_weights_from_two_processes(folder):
    data = pairs(folder)
    check_same(folder, "cnn", data)  # dropout and random unpooling behind convolutions
    check_same(folder, "bra", data)  # dropout behind recurrent layers
    # AdamW divides a gradient by its size: where it is nearly 0, its rounding counts.
    check_same(folder, "refine", data, others=1e-3)


@case
def a_method_for_poses_gets_the_same_weights_from_two_and_from_three_processes(folder):
    data = people(folder)
    check_same(folder, "inertial", data)
    check_same(folder, "inertial", data, processes=3)  # of a batch of 32: 10, 11 and 11


@case
def a_method_that_fuses_gets_the_same_weights_from_two_processes(folder):
    check_same(folder, "gated", people(folder))


def windows(folder):
    _, data = people(folder)
    data_sets.done("windows", data, "-o", folder / "w.npz", "--length", "64", "--step", "64", "--rate", "60", "--stream", "mocap",
                   "--valid", "0.2")
    return "--windows", folder / "w.npz"


def without_blas(err):
    """The lines of stderr without the warning of a slow BLAS library, which a loaded machine causes."""
    return b"".join(line for line in err.splitlines(True) if b"warning: the BLAS library" not in line)


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def started(words, env):
    return subprocess.Popen([PROGRAM, *map(str, words)], env={**os.environ, **env}, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


@case
def processes_of_a_cluster_find_each_other_by_their_environment(folder):
    data, out = windows(folder), folder / "cluster.safetensors"
    place = {"MASTER_ADDR": "localhost", "MASTER_PORT": str(free_port())}
    for names in (("RANK", "WORLD_SIZE"), ("SLURM_PROCID", "SLURM_STEP_NUM_TASKS")):
        out.unlink(missing_ok=True)
        both = [started(words_of("inertial", data, out), {**place, names[0]: str(rank), names[1]: "2"}) for rank in (0, 1)]
        said = [one.communicate(timeout=300) for one in both]
        assert [one.returncode for one in both] == [0, 0], said
        assert b"trained, loss" in said[0][0] and said[1][0] == b"", said
        one = folder / "one.safetensors"
        if not one.exists():
            trained("inertial", data, one)
        assert difference(one, out) < 1e-4


def workers_of(process):
    """Ids of the processes of kinalign-learn that this one has started, by rank."""
    out = {}
    for path in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(path.read_text().rpartition(")")[2].split()[1])
            job = path.with_name("cmdline").read_bytes().split(b"\0")
        except (OSError, ValueError):
            continue
        if parent == process.pid and len(job) > 1 and job[0] == b"kinalign-learn":
            name = pathlib.Path(job[1].decode()).name.split(".")
            out[int(name[1]) if len(name) == 3 else 0] = int(path.parent.name)
    return out


def wait_for(condition, seconds=120):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.05)


@case
def a_process_that_dies_ends_the_others_at_once_and_the_run_goes_on_later(folder):
    data, out = people(folder), folder / "m.safetensors"
    words = ("train", "inertial", *data, "-o", out, "--steps", "230", "--jobs", "1", "--processes", "2")
    kept = folder / "m.training/checkpoint.safetensors"
    run = started(words, {})
    wait_for(kept.exists, 300)  # after 200 steps
    workers = workers_of(run)
    assert set(workers) == {0, 1}, workers
    os.kill(workers[1], signal.SIGKILL)
    at = time.monotonic()
    _, err = run.communicate(timeout=60)
    assert time.monotonic() - at < 15, time.monotonic() - at
    assert run.returncode == 3, err
    assert without_blas(err) == (
        b"kinalign train: expected process 1 (of 0 to 1) of kinalign-learn to end with exit code 0, found signal 9\n"), err
    assert not out.exists() and not any(pathlib.Path(f"/proc/{pid}").exists() for pid in workers.values())
    ran = kinalign(*words, "--resume", memory=1 << 36, seconds=300)
    assert ran.returncode == 0, ran.stderr
    whole = folder / "whole.safetensors"
    ran = kinalign(*words[:5], whole, *words[6:], memory=1 << 36, seconds=300)
    assert ran.returncode == 0, ran.stderr
    assert header_and_weights(whole)[0]["training"] == header_and_weights(out)[0]["training"]
    assert difference(whole, out) == 0


@case
def processes_of_different_jobs_are_refused(folder):
    data = windows(folder)
    place = {"MASTER_ADDR": "127.0.0.1", "MASTER_PORT": str(free_port()), "WORLD_SIZE": "2"}
    both = [started(words_of("inertial", data, folder / "m.safetensors", "--seed", rank), {**place, "RANK": str(rank)})
            for rank in (0, 1)]
    said = [without_blas(one.communicate(timeout=300)[1]).decode() for one in both]
    assert [one.returncode for one in both] == [3, 3], said
    assert said[1] == ("kinalign train: expected the same job, data and checkpoint in every process, "
                       "found others in process 1 than in process 0\n"), said[1]
    assert said[0] == ("kinalign train: expected all processes of the training to run to the end, found a process that ended early (its own message says why)\n"), said[0]


@case
def a_cluster_without_an_address_or_with_a_data_set_is_told(folder):
    step = {"RANK": "1", "WORLD_SIZE": "2"}
    for more, env, says in (
            (("--windows", "w.npz"), {}, "MASTER_ADDR: expected the address of the first process's machine in the environment, "
                                         "found no address in process 1 of 2"),
            (("--data", "d"), {"MASTER_ADDR": "a"}, "--data: expected a file of windows (--windows) that all processes read, "
                                                    "found process 1 of 2"),
            (("--windows", "w.npz", "--processes", "2"), {"MASTER_ADDR": "a"},
             "--processes: expected 1 in each process of a cluster, found process 1 of 2"),
            (("--windows", "w.npz"), {"MASTER_ADDR": "a", "MASTER_PORT": "x"}, "MASTER_PORT: expected a TCP port, found x")):
        ran = kinalign("train", "inertial", *more, "-o", folder / "m.safetensors", env={**step, **env})
        assert ran.stderr.decode().splitlines()[0] == f"kinalign train: {says}", ran.stderr
        assert ran.returncode == 3, ran.returncode
    wrong("train", "inertial", "--windows", "w.npz", "-o", "m.safetensors", "--processes", "33",
          says="--processes: expected a whole number from 1 to 32, found 33")


sys.exit(main())
