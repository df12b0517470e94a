# SPDX-License-Identifier: Apache-2.0
"""A build in shares, started by a real Slurm on this machine and by mpirun.
dataset_cluster_check.py BUILD_FOLDER [CASE...]"""
import contextlib
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import PROGRAM, SANITIZED, Skip, case, main
from data_sets import answer, contents, done, small_set

CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={munge}
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SlurmctldPort={port}
SlurmdPort={node_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
MailProg=/bin/true
NodeName={host} CPUs={cores} RealMemory=2000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=FORCE:8
"""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def in_time(what, seconds=30):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if what():
            return
        time.sleep(0.05)
    raise AssertionError("not within the time")


@contextlib.contextmanager
def slurm(folder):
    """The environment of a cluster of one node, which is this machine."""
    if os.geteuid() != 0 or not all(map(shutil.which, ("slurmctld", "slurmd", "srun", "munged"))):
        raise Skip("needs root, slurmctld, slurmd, slurm-client and munge")
    folder = pathlib.Path("/run") / f"kinalign_slurm_{os.getpid()}"  # munge wants a folder of root's above
    folder.mkdir(mode=0o755)
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.write_bytes(os.urandom(128))
    key.chmod(0o600)
    text = CONFIGURATION.format(host=socket.gethostname().split(".")[0], folder=folder, cores=os.cpu_count(),
                                munge=folder / "munge", port=free_port(), node_port=free_port())
    (folder / "slurm.conf").write_text(text)
    running = []
    try:
        munge = ["munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder}/munge",
                 f"--pid-file={folder}/munge.pid", f"--log-file={folder}/munge.log", f"--seed-file={folder}/seed"]
        for words in (munge, ["slurmctld", "-D", "-f", f"{folder}/slurm.conf"],
                      ["slurmd", "-D", "-f", f"{folder}/slurm.conf"]):
            running.append(subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                            start_new_session=True))
            in_time(lambda: (folder / "munge").exists())
        env = {**os.environ, "SLURM_CONF": f"{folder}/slurm.conf"}

        def is_idle():
            ran = subprocess.run(["sinfo", "-h", "-o", "%t"], env=env, capture_output=True, text=True, check=False)
            return ran.stdout.strip() == "idle"
        try:
            in_time(is_idle)
        except AssertionError:
            logs = "\n".join(f"{p.name}: {p.read_text()[-1500:]}" for p in folder.glob("*.log"))
            raise AssertionError(f"no cluster came up\n{logs}") from None
        yield env
    finally:
        for one in reversed(running):
            one.terminate()
            with contextlib.suppress(subprocess.TimeoutExpired):
                one.wait(10)
            one.kill()
        shutil.rmtree(folder, ignore_errors=True)


def run(words, env, cwd):
    ran = subprocess.run([str(word) for word in words], env=env, cwd=cwd, capture_output=True, text=True, check=False,
                         timeout=120)
    assert ran.returncode == 0, (words, ran.stdout, ran.stderr)
    return ran.stdout


def built_once(folder, takes=6):
    """A data set, and what is in it when one process has built it."""
    data = small_set(folder, takes=takes)
    plain = shutil.copytree(data, folder / "plain")
    done("build", plain, "--jobs", "1")
    return data, contents(plain)


def own_shares(text):
    """How many takes each task made: its lines say so."""
    return sorted(int(line.split(" take")[0].split()[-1]) for line in text.splitlines() if "made" in line)


@case
def tasks_of_a_real_slurm_share_a_build_and_lose_nothing(folder):
    with slurm(folder) as env:
        data, wanted = built_once(folder)
        build = [PROGRAM, "dataset", "build", "--jobs", "1"]
        for tasks in (2, 3):
            other = shutil.copytree(data, folder / f"srun{tasks}")
            said = run(["srun", f"-n{tasks}", "--overcommit", *build, other], env, folder)
            assert contents(other) == wanted, said
            made = own_shares(said)
            assert len(made) == tasks and sum(made) == 6 and made[0] > 0, said
        whole = shutil.copytree(data, folder / "batch")  # a batch script of two tasks, without srun
        run(["sbatch", "-W", "-n2", "--overcommit", "-o", folder / "batch.txt", "--wrap", f"'{build[0]}' dataset build '{whole}'"],
            env, folder)
        assert contents(whole) == wanted
        array = shutil.copytree(data, folder / "array")
        run(["sbatch", "-W", "--array=5-7", "-o", folder / "array%a.txt", "--wrap",
             f"'{build[0]}' dataset build --jobs 1 '{array}'"], env, folder)
        assert contents(array) == wanted
        made = own_shares("".join((folder / f"array{k}.txt").read_text() for k in (5, 6, 7)))
        assert len(made) == 3 and sum(made) == 6 and made[0] > 0, made
        steps = shutil.copytree(data, folder / "steps")  # srun within each task of an array
        run(["sbatch", "-W", "-n2", "--overcommit", "--array=0-1", "-o", folder / "steps%a.txt", "--wrap",
             f"srun -n2 --overcommit '{build[0]}' dataset build --jobs 1 '{steps}'"], env, folder)
        assert contents(steps) == wanted
        made = own_shares("".join((folder / f"steps{k}.txt").read_text() for k in (0, 1)))
        assert len(made) == 4 and sum(made) == 6 and made[0] > 0, made
        assert len(answer("list", steps)["takes"]) == 6


@case
def tasks_of_mpirun_share_a_build(folder):
    if shutil.which("mpirun") is None:
        raise Skip("needs openmpi-bin")
    if SANITIZED:
        raise Skip("mpirun starts its tasks with limits that sanitizers exceed")
    data, wanted = built_once(folder)
    for tasks in (2, 3):
        other = shutil.copytree(data, folder / f"mpi{tasks}")
        said = run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", tasks, PROGRAM, "dataset", "build", other,
                    "--jobs", "1"], {**os.environ}, folder)
        assert contents(other) == wanted
        made = own_shares(said)
        assert len(made) == tasks and sum(made) == 6 and made[0] > 0, said


if __name__ == "__main__":
    sys.exit(main())
