# SPDX-License-Identifier: Apache-2.0
"""What stands in a recording whose program or disk fails it.
record_disk_check.py BUILD_FOLDER [CASE...]"""
import contextlib
import json
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import LONG, SANITIZED, Skip, case, kinalign, main
from mcap_walk import Walk
from recording_program import Recording, Sender, frame, mark, numbers, sender_to

KILLS = 200 if LONG else 20


@contextlib.contextmanager
def small_disk(folder, megabytes):
    small = folder / "small"
    small.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tmpfs", str(small)], capture_output=True,
                      check=False).returncode != 0:
        raise Skip("no right to mount a small disk")
    try:
        yield small
    finally:
        subprocess.run(["umount", str(small)], check=True)


@case
def a_kill_at_any_moment_costs_at_most_the_last_second_and_recover_closes_what_is_left(folder):
    draw = random.Random(11)
    for k in range(KILLS):
        recording = Recording(folder / f"takes{k}")
        with Sender(recording.port) as sender:
            time.sleep(draw.uniform(0.1, 10 if LONG else 3))
            killed = time.monotonic()  # before the signal: a loaded machine may stop this program after it
            recording.program.send_signal(signal.SIGKILL)
            recording.program.communicate()
        torn = recording.path.read_bytes()
        found = set(numbers(Walk(recording.path)))
        owed = [n for n, sent in enumerate(sender.sent) if sent < killed - 1]
        lost = [n for n in owed if n not in found]
        assert not lost, f"kill {k}: {len(lost)} of {len(owed)} messages lost, the first {lost[0]}"
        whole = folder / f"whole{k}.mcap"
        done = kinalign("recover", recording.path, "-o", whole, "--json")
        assert done.returncode in (0, 1), done.stderr
        assert json.loads(done.stdout)["messages"] >= len(found), done.stdout
        assert recording.path.read_bytes() == torn, "the torn file was touched"
        assert kinalign("recover", whole, "-o", folder / f"again{k}.mcap").returncode == 0, "not whole"


@case
def a_disk_with_64_mib_left_ends_the_take_in_order(folder):
    with small_disk(folder, 80) as small:
        recording = Recording(small / "takes")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
            sent, end = 0, time.monotonic() + 60
            while recording.program.poll() is None and time.monotonic() < end:
                one.sendto(frame(sent) + bytes(30000), ("127.0.0.1", recording.port))
                sent += 1
                time.sleep(0.01)
        out, err = recording.program.communicate(timeout=60)
        events = [json.loads(line) for line in out.splitlines()]
        names = [event["event"] for event in events]
        assert recording.program.returncode == 1 and "the take ends now and is complete" in err, (names, err)
        assert "disk_full" in names and "disk_low" in names and "disk_failed" not in names, names
        assert events[-1]["event"] == "stopped" and events[-1]["dropped"] == 0, events[-1]
        walk = Walk(recording.path)
        found = numbers(walk)
        assert walk.closed and found == list(range(len(found))) and len(found) > 100, len(found)


def fill(folder):
    """Another program takes every byte that is left."""
    with (folder / "other").open("wb", buffering=0) as other, contextlib.suppress(OSError):
        while True:
            other.write(bytes(4096))


def recording_on_a_full(disk):
    """One message is on it, 28 have reached the machine, and the program knows that it can't write them."""
    recording = Recording(disk / "takes", "--marks-port", "0")
    with sender_to(recording.port) as device:
        device(frame(0))
        recording.until("status")
        time.sleep(1)  # what came stands in the file
        recording.program.send_signal(signal.SIGSTOP)  # else it ended in order before the last byte
        fill(disk)
        for number in range(1, 29):
            device(frame(number) + bytes(30000))
        recording.program.send_signal(signal.SIGCONT)
    recording.until("end_refused")
    return recording


@case
def what_a_full_disk_refuses_at_the_end_is_written_when_somebody_makes_room(folder):
    with small_disk(folder, 80) as small:
        recording = recording_on_a_full(small)
        (small / "other").unlink()
        last = recording.until("stopped")[-1]
        assert recording.program.wait(60) == 1
        assert last["dropped"] == 0, last
        found = {number for path in last["files"] for number in numbers(Walk(pathlib.Path(path)))}
        assert found == set(range(29)), sorted(found)


@case
def while_the_end_waits_for_the_disk_who_calls_is_answered(folder):
    with small_disk(folder, 80) as small, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as caller:
        recording = recording_on_a_full(small)
        caller.settimeout(5)
        call = json.dumps({"schema": "kinalign.mark/1", "kind": "text", "text": "next", "id": "1"}).ljust(200)
        caller.sendto(call.encode(), ("127.0.0.1", recording.started["ports"]["marks"]))
        assert json.loads(caller.recv(1000))["is"] == "new"
        recording.program.send_signal(signal.SIGINT)
        recording.until("stopped")
        recording.program.communicate(timeout=60)  # while it runs the disk is in use


@case
def what_a_full_disk_never_takes_is_counted_and_told(folder):
    with small_disk(folder, 80) as small:
        recording = recording_on_a_full(small)
        recording.program.send_signal(signal.SIGINT)  # give it up
        last = recording.until("stopped")[-1]
        assert recording.program.wait(60) == 3
        err = recording.program.communicate()[1]
        assert last["dropped"] >= 28 and "No space left" in err, (last, err)
        found = {number for path in last["files"] for number in numbers(Walk(pathlib.Path(path)))}
        assert 0 in found, "what was there before is lost"


@case
def a_folder_that_is_removed_is_told_within_a_second_or_two_and_the_end_says_so(folder):
    recording = Recording(folder / "takes")
    with Sender(recording.port):
        recording.until("status")
        shutil.rmtree(folder / "takes")
        failed = recording.until("disk_failed")[-1]
        assert "it was removed" in failed["what"] and failed["goes_on_in"] == "", failed
        (folder / "takes").mkdir()
        assert recording.until("disk_failed")[-1]["goes_on_in"].endswith("take_01.part2.mcap")
        time.sleep(0.5)
    code, events, err = recording.end()
    assert code == 1, err
    assert numbers(Walk(pathlib.Path(events[-1]["files"][-1]))), "nothing of what came afterwards"


@contextlib.contextmanager
def standing_still():
    """A file, and the environment of a program whose syncs, and the making of its recordings, last as long as it is there."""
    if SANITIZED:
        raise Skip("a sanitizer comes before every other library")
    with tempfile.TemporaryDirectory() as plain:  # LD_PRELOAD ends a name at a space
        still, source, library = (pathlib.Path(plain) / name for name in ("still", "still.c", "still.so"))
        source.write_text("#include <fcntl.h>\n#include <string.h>\n#include <sys/syscall.h>\n#include <unistd.h>\n"
                          f'static void stand(void) {{ while (access("{still}", F_OK) == 0) usleep(10000); }}\n'
                          "int fsync(int fd) { stand(); return (int)syscall(SYS_fsync, fd); }\n"
                          "int open(const char* path, int flags, ...) { if (strstr(path, \".mcap\")) stand(); "
                          "return (int)syscall(SYS_openat, AT_FDCWD, path, flags, 0644); }\n")
        subprocess.run(["cc", "-shared", "-fPIC", "-o", str(library), str(source)], check=True)
        yield still, {"LD_PRELOAD": str(library)}


@case
def a_disk_that_stands_still_can_be_left_and_what_it_took_before_is_whole(folder):
    with standing_still() as (still, env):
        recording = Recording(folder / "takes", env=env)
        with Sender(recording.port) as sender:
            time.sleep(1.5)
            still.touch()
            stood = time.monotonic()
            time.sleep(0.5)
            recording.program.send_signal(signal.SIGINT)
            waits = recording.until("end_waits")[-1]
        assert waits["waiting_bytes"] > 0, waits
        assert recording.program.poll() is None, "it left by itself"
        recording.program.send_signal(signal.SIGINT)
        out, err = recording.program.communicate(timeout=10)
    assert recording.program.returncode == 3 and "does not respond" in err, (recording.program.returncode, err)
    assert "stopped" not in out, out
    found = set(numbers(Walk(recording.path)))
    owed = [n for n, sent in enumerate(sender.sent) if sent < stood - 1]
    assert owed and found.issuperset(owed), (len(owed), len(found))


@case
def a_disk_that_stands_still_for_a_while_loses_nothing(folder):
    with standing_still() as (still, env):
        recording = Recording(folder / "takes", env=env)
        with Sender(recording.port):
            still.touch()
            time.sleep(0.5)
            recording.program.send_signal(signal.SIGINT)
            recording.until("end_waits")
            still.unlink()
            last = recording.until("stopped")[-1]
        assert recording.program.wait(10) == 0 and last["dropped"] == 0, last
    walk = Walk(recording.path)
    found = numbers(walk)
    assert walk.closed and found == list(range(len(found))) and found, len(found)


def start_take(recording):
    """By a call to one that waits for it."""
    mark(recording.started["ports"], "start")


@case
def what_comes_while_a_disk_takes_its_time_to_begin_a_take_stands_in_it(folder):
    with standing_still() as (still, env):
        recording = Recording(folder / "takes", "--wait", "--marks-port", "0", "--pre-roll-s", "0", first="waiting", env=env)
        still.touch()
        start_take(recording)
        recording.until("mark")
        with Sender(recording.port) as sender:
            time.sleep(1)
        status = recording.until("status")[-1]
        while status.get("waiting_bytes", 0) == 0:  # told before any chunk was full
            status = recording.until("status")[-1]
        assert not list((folder / "takes").iterdir()), status
        still.unlink()
        path = pathlib.Path(recording.until("started")[-1]["file"])
        code, events, err = recording.end()
    assert code == 0 and events[-1]["dropped"] == 0, err
    assert numbers(Walk(path)) == list(range(len(sender.sent)))


@case
def a_take_whose_folder_is_gone_when_it_begins_waits_for_one_and_has_all_that_came(folder):
    takes = folder / "takes"
    recording = Recording(takes, "--wait", "--marks-port", "0", "--pre-roll-s", "0", first="waiting")
    takes.rmdir()
    takes.write_text("in the way")
    start_take(recording)
    assert recording.until("disk_failed")[-1]["goes_on_in"] == ""
    with Sender(recording.port) as sender:
        time.sleep(1)
    takes.unlink()
    path = pathlib.Path(recording.until("started")[-1]["file"])
    code, events, err = recording.end()
    assert code == 0 and events[-1]["dropped"] == 0, err
    assert numbers(Walk(path)) == list(range(len(sender.sent)))


@case
def trials_that_begin_and_end_while_the_disk_stands_still_are_kept_in_two_files_and_the_merged_ones_are_told(folder):
    with standing_still() as (still, env):
        recording = Recording(folder / "takes", "--wait", "--repeat", "--marks-port", "0", "--pre-roll-s", "0",
                              first="waiting", env=env)
        ports = recording.started["ports"]
        still.touch()
        with sender_to(recording.port) as device:
            for trial in range(3):
                mark(ports, "start")
                recording.until("mark")
                device(frame(trial))
                time.sleep(0.3)
                mark(ports, "stop")
                recording.until("mark")
        time.sleep(2)
        still.unlink()
        said = [recording.until("stopped") for _ in range(2)]
        code, _, err = recording.end()
    assert code == 1 and err.count("begins no take") == 1, err
    files = [each[-1]["files"] for each in said]
    assert [[pathlib.Path(file).name for file in each] for each in files] == [["take_01.mcap"], ["take_02.mcap"]], files
    assert [numbers(Walk(pathlib.Path(file))) for [file] in files] == [[0], [1, 2]]


@case
def ctrl_c_ends_the_trial_that_goes_on_while_the_disk_still_writes_the_one_before(folder):
    with standing_still() as (still, env):
        recording = Recording(folder / "takes", "--wait", "--repeat", "--marks-port", "0", first="waiting", env=env)
        ports = recording.started["ports"]
        with sender_to(recording.port) as device:
            mark(ports, "start")
            recording.until("started")
            device(frame(0))
            time.sleep(0.3)
            still.touch()
            mark(ports, "stop")
            recording.until("end_waits")
            mark(ports, "start")
            recording.until("mark")
            device(frame(1))
            time.sleep(0.3)
            recording.program.send_signal(signal.SIGINT)
            time.sleep(0.5)
            device(frame(2))  # when all is over
            time.sleep(0.3)
        assert recording.program.poll() is None, "it left by itself"
        still.unlink()
        stopped = [recording.until("stopped")[-1]["files"] for _ in range(2)]
        out, err = recording.program.communicate(timeout=30)
    assert recording.program.returncode == 0 and "Ctrl-C pressed twice discards" in err, (out, err)
    found = [numbers(Walk(pathlib.Path(file))) for [file] in stopped]
    assert found[0][0] == 0 and found[1][-1] == 1, found


@case
def a_disk_that_stands_still_when_a_take_begins_can_be_left(folder):
    with standing_still() as (still, env):
        recording = Recording(folder / "takes", "--wait", "--marks-port", "0", first="waiting", env=env)
        still.touch()
        start_take(recording)
        while "bytes" not in recording.until("status")[-1]:  # the take has begun
            pass
        recording.program.send_signal(signal.SIGINT)
        recording.until("end_waits")
        assert recording.program.poll() is None, "it left by itself"
        recording.program.send_signal(signal.SIGINT)
        err = recording.program.communicate(timeout=10)[1]
    assert recording.program.returncode == 3 and "does not respond" in err, (recording.program.returncode, err)


if __name__ == "__main__":
    sys.exit(main())
