# SPDX-License-Identifier: Apache-2.0
"""The real program against a host in Python: host_node_check.py BINARY_DIR

The host answers as docs/formats/imu_node.md says, and holds what it gets against the truth that host_node prints.
"""
import dataclasses
import json
import math
import pathlib
import signal
import socket
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests/firmware")]
import datagrams
from run_cases import case, in_time, run_cases

HOST_NODE = pathlib.Path(sys.argv[1]).resolve() / "firmware/host_node"
KEY = bytes(range(16))
FORGER = bytes(16)


def raw_ns():
    return time.clock_gettime_ns(time.CLOCK_MONOTONIC_RAW)


@dataclasses.dataclass
class Got:
    datagram: datagrams.Datagram
    h_rx: int
    sender: tuple


class Host:
    """A server that keeps what it got, and when it answered."""

    def __init__(self, family=socket.AF_INET, key=None, answers=True):
        self.socket = socket.socket(family, socket.SOCK_DGRAM)
        self.socket.bind(("::1" if family == socket.AF_INET6 else "127.0.0.1", 0))
        self.socket.settimeout(0.05)
        self.key, self.answers = key, answers
        self.got, self.replied, self.confirmed = [], {}, {}

    def address(self):
        host, port = self.socket.getsockname()[:2]
        return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"

    def serve_one(self):
        try:
            data, sender = self.socket.recvfrom(2000)
        except TimeoutError:
            return
        got = Got(datagrams.opened(data, self.key), raw_ns(), sender)
        self.got.append(got)
        if self.answers:
            for answer in self.answers_to(got.datagram, got.h_rx):
                self.socket.sendto(answer, sender)

    def answers_to(self, datagram, h_rx):
        number = len(self.replied)
        nonce = number * 2654435761 % 2**32
        if datagram.kind == datagrams.FRAME:
            self.replied[number] = (raw_ns(), nonce)
            yield datagrams.reply(datagram.origin, number, nonce, self.key, True)
        elif datagram.kind == datagrams.REQUEST:
            self.replied[number] = (raw_ns(), nonce)
            self.confirmed[nonce] = (h_rx, raw_ns())
            yield datagrams.answer(datagram.origin, nonce, *self.confirmed[nonce], self.key)

    def run(self, *options, seconds=1.5):
        """host_node's report."""
        command = [str(HOST_NODE), "--server", self.address(), "--id", "7", "--seconds", str(seconds), *options]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            while process.poll() is None:
                self.serve_one()
            for _ in range(2):
                self.serve_one()
            assert process.returncode == 0
            self.err = process.stderr.read()
            lines = process.stdout.read().splitlines()
        assert len(lines) == 1, lines
        return json.loads(lines[0])

    def kinds(self, kind):
        return [got for got in self.got if got.datagram.kind == kind]


def host_from_node(truth, counter_us):
    """ns of the host's raw clock, at which the counter stood there."""
    return truth["raw_ns"] + (counter_us - truth["counter_us"]) * 1e3 / (1 + truth["drift_ppm"] * 1e-6)


def check_sample(sample, stamp_us):
    """By the formula of firmware/host_node/formula.h."""
    t, pace = stamp_us * 1e-6, 2 * math.pi * 0.4
    angle = math.sin(pace * t)
    expected = [0, 9.80665 * math.cos(angle), -9.80665 * math.sin(angle), pace * math.cos(pace * t), 0, 0]
    if sample.present & 4:
        expected += [math.cos(angle / 2), math.sin(angle / 2), 0, 0]
    assert all(abs(a - b) < 1e-6 for a, b in zip(sample.values, expected, strict=True)), (sample, expected)


def secret(folder, text=KEY.hex() + "\n", mode=0o600):
    path = folder / "key"
    path.write_text(text)
    path.chmod(mode)
    return str(path)


def stamps_of(frames):
    return [frame.datagram.n_tx - sample.age_us for frame in frames for sample in frame.datagram.samples]


@case
def samples_arrive_as_they_were_taken_with_stamps_on_a_grid(_):
    host = Host()
    report = host.run("--sample-rate", "200", "--rate", "20", "--orientation", "--offset", "1000")
    frames = host.kinds(datagrams.FRAME)
    assert report["sent"] == len(frames) <= 30, report
    in_time(len(frames) >= 10, report)
    stamps = stamps_of(frames)
    assert len(stamps) == report["samples_sent"] >= report["taken"] - 11
    assert all(1e9 <= stamp for stamp in stamps)
    for stamp, sample in zip(stamps, [s for f in frames for s in f.datagram.samples]):
        assert sample.present == 15
        check_sample(sample, stamp)
    # where the machine is busy a tick is late or missed, but never early
    assert all(stamp - 1e9 >= 5_000 * (k + 1) - 1 for k, stamp in enumerate(stamps))
    assert report["ticks"] == report["taken"] + report["missed"], report
    in_time(report["ticks"] >= 1.4 * 200, report)


@case
def counter_and_echo_bound_the_truth_on_both_sides(_):
    for drift in ("0", "80", "-80"):
        host = Host()
        report = host.run("--drift-ppm", drift, "--offset", "5", seconds=1)
        (truth,) = report["truth"]
        frames = host.kinds(datagrams.FRAME)
        echoes = [frame.datagram.echo for frame in frames if frame.datagram.echo]
        for frame in frames:
            assert host_from_node(truth, frame.datagram.n_tx) <= frame.h_rx, "sent before it was stamped"
        for number, nonce, n_rx in echoes:
            h_tx, ours = host.replied[number]
            assert nonce == ours
            assert h_tx <= host_from_node(truth, n_rx + 1), "received before it was sent"
        in_time(len(echoes) >= len(frames) // 2 and report["accepted"] >= len(frames) - 4, report)


@case
def a_node_with_a_key_signs_and_believes_nobody_else(folder):
    host = Host(key=KEY)
    assert host.run("--key-file", secret(folder))["sync"] == "locked"
    forger = Host(key=KEY)
    forger.answers_to = lambda datagram, _: [datagrams.reply(datagram.origin, 1, 1, FORGER),
                                             datagrams.reply(datagram.origin, 1, 1)]
    report = forger.run("--key-file", secret(folder))
    assert report["accepted"] == 0 and report["wrong_mac"] > 10 and report["no_mac"] > 10, report
    assert not any(got.datagram.echo for got in forger.got)


@case
def a_node_that_is_not_answered_says_so_once_with_the_likely_causes_and_when_it_is_answered(folder):
    for keyed in (False, True):
        host = Host(key=KEY if keyed else None, answers=False)
        begin = time.monotonic()
        answered = host.answers_to
        host.answers_to = lambda *got: answered(*got) if time.monotonic() > begin + 6.5 else ()
        host.answers = True
        host.run(*(("--key-file", secret(folder)) if keyed else ()), seconds=7.5)
        cause = ("its --lab-key is not the one that this node's key was made from, or is missing" if keyed else
                 "it has a --lab-key, so this node needs --key-file")
        assert host.err == (f"host_node: {host.address()} has not answered for 5 s: either no kinalign time-server "
                            f"--node-port is there, or {cause}\n"
                            f"host_node: {host.address()} answers now\n"), host.err


@case
def a_node_whose_answers_have_another_key_says_that(folder):
    host = Host(key=KEY)
    host.answers_to = lambda datagram, _: [datagrams.reply(datagram.origin, 1, 1, FORGER)]
    host.run("--key-file", secret(folder), seconds=6)
    assert host.err == (f"host_node: answers of {host.address()} are refused: they are not signed with the key in --key-file\n"), host.err


@case
def a_node_that_is_answered_is_quiet(_):
    host = Host()
    host.run(seconds=6)
    assert host.err == "", host.err


@case
def over_IPv6_it_is_the_same(_):
    host = Host(socket.AF_INET6)
    accepted = host.run()["accepted"]
    assert accepted > 0
    in_time(accepted > 15, accepted)


@case
def without_a_counter_each_answer_is_confirmed(folder):
    host = Host(key=KEY)
    report = host.run("--clockless", "--key-file", secret(folder))
    requests, confirms = host.kinds(datagrams.REQUEST), host.kinds(datagrams.CONFIRM)
    assert len(requests) == report["requests"] and len(confirms) == report["confirms"], report
    assert all(len(r.datagram.samples) == 1 and r.datagram.samples[0].age_us == 0 for r in requests)
    for confirm in confirms:
        nonce, *times = confirm.datagram.times
        assert tuple(times) == host.confirmed[nonce]
    in_time(len(requests) >= 15 and len(confirms) >= len(requests) - 4, report)


@case
def a_reboot_is_a_new_boot_id_with_its_counter_and_numbers_from_zero(_):
    host = Host()
    report = host.run("--offset", "100", "--reboot-at", "0.5", "--reboot-at", "1")
    boots = list(dict.fromkeys(frame.datagram.origin[1] for frame in host.got))
    assert boots == [truth["boot_id"] for truth in report["truth"]] and len(set(boots)) == 3
    assert report["reboots"] == 2
    for boot in boots[1:]:
        frames = [frame for frame in host.got if frame.datagram.origin[1] == boot]
        assert frames[0].datagram.origin[2] == 0 and frames[0].datagram.n_tx < 200_000
        assert frames[0].datagram.echo is None
    same = Host()
    report = same.run("--boot-id", "99", "--same-boot-id", "--reboot-at", "0.5", seconds=1)
    assert {frame.datagram.origin[1] for frame in same.got} == {99}


@case
def steps_and_drifts_of_the_counter_are_in_the_truth(_):
    host = Host()
    report = host.run("--step", "0.4:0.02", "--step", "0.8:-0.02", "--drift", "1:500")
    truths = report["truth"]
    assert [truth["drift_ppm"] for truth in truths] == [0, 0, 0, 500]
    ends = [truth["raw_ns"] for truth in truths[1:]] + [raw_ns()]
    for truth, end in zip(truths, ends):
        frames = [frame for frame in host.got if truth["raw_ns"] + 100e6 < frame.h_rx < end]
        late = [frame.h_rx - host_from_node(truth, frame.datagram.n_tx) for frame in frames]
        in_time(late, truth)
        assert min(late) >= 0, late
        in_time(min(late) < 10e6, late)  # 20 ms, were a step not in it


@case
def an_outage_loses_nothing_that_fits(_):
    host = Host()
    report = host.run("--outage", "0.3:1", "--boot-id", "5", seconds=2)
    frames = host.kinds(datagrams.FRAME)
    assert [frame.datagram.origin[2] for frame in frames] == list(range(len(frames)))
    stamps = stamps_of(frames)
    assert report["dropped"] == 0
    in_time(max(b - a for a, b in zip(stamps, stamps[1:])) < 150_000, "a hole in the samples")
    assert max(b.h_rx - a.h_rx for a, b in zip(frames, frames[1:])) > 0.9e9, "no outage"


@case
def another_port_is_the_same_node(_):
    host = Host()
    report = host.run("--rebind-at", "0.7")
    assert len({frame.sender for frame in host.got}) == 2
    assert len({frame.datagram.origin[1] for frame in host.got}) == 1
    in_time(report["accepted"] >= len(host.got) - 6, report)


@case
def a_narrow_counter_wraps(_):
    host = Host()
    host.run("--narrow", "--offset", str(2**32 / 1e6 - 0.7))
    counters = [frame.datagram.n_tx for frame in host.got]
    assert max(counters) > 2**32 - 100_000 and counters[-1] < 900_000
    stamps = [stamp % 2**32 for stamp in stamps_of(host.got)]
    assert sum(b < a for a, b in zip(stamps, stamps[1:])) == 1


@case
def a_host_that_is_not_there_yet_is_found_when_it_comes(_):
    host = Host()
    address = host.socket.getsockname()
    host.socket.close()
    command = [str(HOST_NODE), "--server", f"127.0.0.1:{address[1]}"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        time.sleep(0.4)
        host.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        host.socket.bind(address)
        host.socket.settimeout(0.05)
        limit = time.monotonic() + 10
        while len(host.replied) < 10 and time.monotonic() < limit:
            host.serve_one()
        process.send_signal(signal.SIGTERM)
        report = json.loads(process.communicate(timeout=10)[0])
    assert report["accepted"] >= 9 and report["sync"] == "locked", report


@case
def sensor_and_battery(_):
    host = Host()
    report = host.run("--sensor-fails", "3", "--battery-mv", "3912")
    samples = [sample for frame in host.got for sample in frame.datagram.samples]
    assert {sample.present for sample in samples} == {0, 11}
    assert abs(report["sensor_fails"] - report["taken"] / 3) <= 1
    assert {frame.datagram.battery for frame in host.got} == {3912}


@case
def the_counter_at_the_start_is_printed_in_all_its_digits(_):
    (truth,) = Host().run("--offset", "1e9", seconds=0.2)["truth"]
    assert isinstance(truth["counter_us"], int) and truth["counter_us"] == 10**15, truth


@case
def what_it_can_not_do_it_says_in_one_line(folder):
    (folder / "folder").mkdir()
    key = secret(folder)
    missing = str(folder / "none")
    for options, code, text in [
            (["--server", "127.0.0.1"], 2, '--server: expected HOST:PORT, or [HOST]:PORT for IPv6, found "127.0.0.1"'),
            (["--server", "::1:5"], 2, '--server: expected HOST:PORT, or [HOST]:PORT for IPv6, found "::1:5"'),
            (["--server", "[::1]:0"], 2, '--server: expected HOST:PORT, or [HOST]:PORT for IPv6, found "[::1]:0"'),
            ([], 2, "expected --server HOST:PORT; --help lists the options"),
            (["--rat", "5"], 2, "unknown option --rat; did you mean --rate? --help lists the options"),
            (["--key_file", "k"], 2, "unknown option --key_file; did you mean --key-file? --help lists the options"),
            (["-clokcless"], 2, "unknown option -clokcless; did you mean --clockless? --help lists the options"),
            (["--xy"], 2, "unknown option --xy; --help lists the options"),
            (["--loud"], 2, "unknown option --loud; --help lists the options"),
            (["--rate"], 2, "--rate: expected a value after it (0.1 to 1000 Hz), found nothing"),
            (["--rate", ""], 2, '--rate: expected 0.1 to 1000 Hz, found ""'),
            (["--rate", "nan"], 2, '--rate: expected 0.1 to 1000 Hz, found "nan"'),
            (["--step", "3"], 2, '--step: expected AT:S, both in seconds, found "3"'),
            (["--outage", "3:-1"], 2, '--outage: expected AT:S, both in seconds, found "3:-1"'),
            (["--server", "h:1", "--key-file", missing], 3,
             f"{missing}: expected a key, found: No such file or directory; "
             "kinalign node-key --lab-key LAB --node N -o FILE makes one"),
            (["--server", "h:1", "--key-file", str(folder / "folder")], 3,
             f"{folder}/folder: expected a regular file with a key, found none"),
            (["--server", "127.0.0.1:x"], 2, '--server: expected HOST:PORT, or [HOST]:PORT for IPv6, found "127.0.0.1:x"')]:
        done = subprocess.run([HOST_NODE, *options], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr, done.stdout) == (code, f"host_node: {text}\n", ""), done
    for mode, text, expected in [
            (0o644, KEY.hex(), "expected mode 0600, so that only you can read the key, found 0644: chmod 600 " + key),
            (0o640, KEY.hex(), "expected mode 0600, so that only you can read the key, found 0640: chmod 600 " + key),
            (0o600, KEY.hex()[1:], "expected a key of 32 hexadecimal digits, found other text"),
            (0o600, KEY.hex() + "0", "expected a key of 32 hexadecimal digits, found other text"),
            (0o600, 2 * KEY.hex(), "expected a key of 32 hexadecimal digits, found 64 digits, the lab's key"),
            (0o600, 3 * KEY.hex(), "expected a key of 32 hexadecimal digits, found other text"),
            (0o600, "", "expected a key of 32 hexadecimal digits, found other text"),
            (0o600, "-" + KEY.hex()[1:], "expected a key of 32 hexadecimal digits, found other text")]:
        done = subprocess.run([HOST_NODE, "--server", "127.0.0.1:9", "--key-file", secret(folder, text, mode)],
                              capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (3, f"host_node: {key}: {expected}\n"), done


@case
def help_names_every_option(_):
    done = subprocess.run([HOST_NODE, "--help"], capture_output=True, text=True, check=True)
    source = (ROOT / "firmware/host_node/options.cpp").read_text()
    flags = source[source.index("static const std::vector<Flag> all"):]
    for name in [line.split('"')[1] for line in flags.splitlines() if line.strip().startswith('{"')]:
        assert name == "help" or f"--{name}" in done.stdout, name


sys.exit(run_cases("kinalign_host_node_"))
