# SPDX-License-Identifier: Apache-2.0
"""The steps of docs/how-to-stamp-own-samples.md, as examples/own_samples.py does it, on what
nodes really sent and the real server printed; host_node tells the truth of each sample.
own_samples_check.py BUILD_FOLDER [CASE...]"""
import json
import math
import pathlib
import select
import socket
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/apps"), str(ROOT / "examples"), str(ROOT / "tests/firmware")]
from cases import BUILD, case, in_time, main

import datagrams
from node_runs import NS_READING, Server, ended, start_node
from own_samples import CUTS, Stamper

TURN_US = 1 << 32


def raw_ns():
    return time.clock_gettime_ns(time.CLOCK_MONOTONIC_RAW)


class Listener:
    """Stands between one node and the server, and reads what passes: (arrival, datagram)."""

    def __init__(self, server_port):
        self.read = []
        self.side = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
        self.side[0].bind(("127.0.0.1", 0))
        self.side[1].connect(("127.0.0.1", server_port))
        self.port = self.side[0].getsockname()[1]
        self.over = threading.Event()
        self.thread = threading.Thread(target=self.pass_on)
        self.thread.start()

    def pass_on(self):
        node = None
        while (ready := select.select(self.side, [], [], 0.1)[0]) or not self.over.is_set():
            for one in ready:
                if one is self.side[0]:
                    data, node = one.recvfrom(2048)
                    self.read.append((raw_ns(), datagrams.opened(data)))
                    self.side[1].send(data)
                else:
                    self.side[0].sendto(one.recv(2048), node)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.over.set()
        self.thread.join()
        for one in self.side:
            one.close()


def samples_of(listener, narrow):
    """(arrival, boot_id, lives, counter in ns): a new life has a new boot id, or its counter falls by
    more than a second; of a narrow counter the turns are counted, which that fall is one of."""
    lives, before, turns = 0, None, 0
    for arrival, datagram in listener.read:
        boot_id, n_tx = datagram.origin[1], datagram.n_tx
        if narrow:
            turns += before is not None and before[1] % TURN_US - n_tx > TURN_US // 2
            n_tx += turns * TURN_US
        lives += before is None or before[0] != boot_id or before[1] - n_tx > 1_000_000
        before = boot_id, n_tx
        for sample in datagram.samples:
            yield arrival, boot_id, lives, 1000 * (n_tx - sample.age_us)


def true_ns(truths, arrival, boot_id, n):
    """When the counter read n: of several moments the last one before the frame arrived."""
    fitting = []
    for truth, following in zip(truths, [*truths[1:], None]):
        at = truth["raw_ns"] + (n + 500 - 1000 * truth["counter_us"]) / (1 + truth["drift_ppm"] * 1e-6)
        end = following["raw_ns"] if following else float("inf")
        if truth["boot_id"] == boot_id and truth["raw_ns"] - 2000 <= at < min(end, arrival) + 2000:
            fitting.append(at)
    return max(fitting)


def stamped(seconds, *words):
    """A node's run by the recipe: of each sample when it was taken and its stamp; and the server."""
    with Server(BUILD) as server:
        with Listener(server.node_port) as listener:
            report = ended(start_node(BUILD, listener.port, 1, "--seconds", seconds, *words))
            time.sleep(0.3)
    stamper = Stamper(server.lines)
    stream = server.said("node")[-1]["stream"]
    rows = [(true_ns(report["truth"], arrival, boot_id, n), stamper.stamp(stream, boot_id, lives, n))
            for arrival, boot_id, lives, n in samples_of(listener, "--narrow" in words)]
    assert len(rows) == report["samples_sent"], (len(rows), report)
    certificates_hold(rows)  # in front of all that may try again
    in_time(len(rows) > 50 * seconds, len(rows), report)
    return rows, report["truth"], server


def certificates_hold(rows):
    for truth, stamp in rows:
        assert stamp is None or stamp[1] - NS_READING <= truth <= stamp[2] + NS_READING, (truth, stamp)


def certified_share(rows, begin, end):
    """Of what was sampled between the two moments."""
    between = [stamp is not None for truth, stamp in rows if begin <= truth < end]
    in_time(len(between) > 50, len(between))
    return sum(between) / len(between)


@case
def every_sample_that_the_recipe_certifies_holds_the_truth_though_the_counter_steps(_):
    for by in ("0.5", "-0.5"):
        rows, truth, server = stamped(16, "--step", f"10:{by}", "--drift-ppm", 40)
        begin, step = truth[0]["raw_ns"], truth[1]["raw_ns"]
        in_time(certified_share(rows, begin + 1.5e9, step - 6.5e9) > 0.8, by)
        in_time(certified_share(rows, step + 3e9, math.inf) > 0.8, by)
        assert certified_share(rows, step - 4e9, step + 1e9) == 0, by
        # A step ends its run with its own word: the lines before it are never those of the next.
        assert {"step", "settled"} <= {line["kind"] for line in server.said("clock_event")} & set(CUTS)


@case
def a_reboot_under_the_old_boot_id_is_another_life_of_the_same_counter(_):
    rows, truth, _ = stamped(10, "--reboot-at", 5, "--same-boot-id")
    assert len(truth) == 2 and truth[0]["boot_id"] == truth[1]["boot_id"], truth
    begin, reboot = truth[0]["raw_ns"], truth[1]["raw_ns"]
    in_time(certified_share(rows, begin + 1.5e9, reboot) > 0.8)
    in_time(certified_share(rows, reboot + 2e9, math.inf) > 0.8)


@case
def a_narrow_counter_is_unwrapped_as_the_log_has_it(_):
    rows, _, server = stamped(8, "--narrow", "--offset", (TURN_US - 4_000_000) / 1e6)
    in_time(certified_share(rows, rows[0][0] + 1.5e9, math.inf) > 0.8)
    assert server.said("node")[-1]["counter_ns"] > 1000 * TURN_US


def own_samples(rows, *words):
    done = subprocess.run([sys.executable, ROOT / "examples/own_samples.py", *words], text=True, input=rows,
                          capture_output=True, check=False)
    return done.returncode, done.stdout, done.stderr


@case
def the_example_prints_a_stamp_or_that_there_is_none(folder):
    certified = {"event": "node", "stream": 0, "boot_id": 5, "lives": 1, "counter_ns": 2_000_000_000,
                 "time_ns": 9_000_000_000, "earliest_ns": 8_999_000_000, "latest_ns": 9_001_000_000,
                 "certainty": "certified", "drift_ppm": 20}
    begun = {"event": "clock_event", "kind": "new_boot", "stream": 0, "begin_ns": 7_000_000_000, "end_ns": 0}
    (folder / "log").write_text("".join(json.dumps(line) + "\n" for line in (
        {"event": "started"}, {"event": "pair"}, begun, certified, {"event": "stopped"})))
    rows = "0 5 1 3500000000\n0 5 1 2500000000\n0 5 2 2500000000\n1 5 1 2500000000\n0 5 1 -100000000\n"
    none = "not certified\n"
    assert own_samples(rows, folder / "log") == (0, none + "9500010000 9498950000 9501050000\n" + 3 * none, "")


@case
def the_example_says_what_is_wrong_with_a_log_and_certifies_nothing_by_one_with_gaps(folder):
    path = folder / "log"
    certified = {"event": "node", "stream": 0, "boot_id": 5, "lives": 1, "counter_ns": 0, "time_ns": 9,
                 "earliest_ns": 8, "latest_ns": 10, "certainty": "certified", "drift_ppm": 0}
    line = json.dumps(certified) + "\n"
    stopped = '{"event": "stopped"}\n'
    path.write_text(line + stopped)  # begun in the middle
    assert own_samples("0 5 1 0\n", path) == (0, "9 8 10\n", "")
    late = json.dumps({**certified, "counter_ns": 140 * 10**9, "time_ns": 140 * 10**9 + 9}) + "\n"
    path.write_text(line + late + late[:30])  # cut short: a withdrawal may be missing
    assert own_samples("0 5 1 0\n0 5 1 20000000000\n", path) == (0, "9 8 10\nnot certified\n", "")
    for text, says in ((line + '{"event": "missed", "lines": 1}\n', "lines are missing"),
                       (line + '{"event": "node_counts", "missed_events": 1}\n', "lines are missing"),
                       (line + '{"event": "started"}\n', "several runs"),
                       ("null\n" + line, "line 1: expected a line of kinalign time-server --json"),
                       ("2026-11-23 node 7: joined\n" + line, "line 1: expected a line of kinalign time-server --json")):
        path.write_text(text)
        code, out, err = own_samples("0 5 1 0\n", path)
        assert (code, out) == (1, "") and says in err and str(path) in err, err
    path.write_text(line + stopped)
    assert "row 2: expected stream" in own_samples("0 5 1 0\n1 2 3\n", path)[2]
    assert "usage" in own_samples("")[2] and "No such file" in own_samples("", folder / "nope")[2]


if __name__ == "__main__":
    sys.exit(main())
