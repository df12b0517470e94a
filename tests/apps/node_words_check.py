# SPDX-License-Identifier: Apache-2.0
"""What the time server tells people of its nodes, while it runs and at its end.
node_words_check.py BUILD_FOLDER [CASE...]"""
import pathlib
import re
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
from cases import BUILD, case, main

from node_runs import Keys, ended, start_node


class TextServer:
    """The program without --json, until the end of the block: then `said` is its summary, `told` its
    live lines without their time of day."""

    def __init__(self, *words):
        self.program = subprocess.Popen(
            [str(cases.PROGRAM), "time-server", "--port", "0", "--node-port", "0", "--listen", "127.0.0.1",
             "--local-stratum", "10", *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for line in self.program.stdout:
            if found := re.match(r"  nodes    port (\d+),", line):
                self.node_port = int(found[1])
                return
        raise AssertionError(self.program.communicate()[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.program.send_signal(signal.SIGINT)
        self.said, err = self.program.communicate(timeout=30)
        assert self.program.returncode == 0, err
        self.told = [re.sub(r"^\S+Z kinalign time-server: ", "", line) for line in err.splitlines()]


@case
def a_clock_beyond_the_assumptions_is_named_once_and_in_the_summary(_):
    with TextServer() as server:
        ended(start_node(BUILD, server.node_port, 7, "--seconds", 10, "--drift-ppm", 300))
    keeps = "its clock keeps contradicting the assumptions (drift above 100 ppm, or the node sleeps)"
    assert len(server.told) <= 8, server.told
    assert [keeps in line for line in server.told] == [False] * (len(server.told) - 1) + [True], server.told
    assert f"not locked: {keeps}" in server.said, server.said


@case
def stamps_that_a_step_costs_are_reported_then_the_step_then_that_it_is_over(_):
    with TextServer() as server:
        ended(start_node(BUILD, server.node_port, 7, "--seconds", 8, "--step", "6:0.5"))
    assert re.fullmatch(r"node 7: joined .*\n"
                        r"node 7: warning: the stamps of 5\.\d s are no longer certified\n"
                        r"node 7: warning: its counter stepped by at least (499|500)\.\d+ ms\n"
                        r"node 7: its counter runs evenly again", "\n".join(server.told)), server.told


@case
def every_node_with_a_wrong_key_is_told_and_stands_in_the_summary(folder):
    keys = Keys(BUILD, folder)
    with TextServer("--lab-key", keys.lab) as server:
        wrong = [start_node(BUILD, server.node_port, i, "--seconds", 5, key=keys.of(i + 10)) for i in (13, 11, 12)]
        wrong.append(start_node(BUILD, server.node_port, 9, "--seconds", 5))
        for node in wrong:
            ended(node)
    assert len(server.told) == 4, server.told
    for node, how in ((9, "frames without a MAC"), (11, "frames signed with another key"), (12, "frames signed with another key"), (13, "frames signed with another key")):
        said = f"warning: a sender that calls itself node {node} is refused: it sends {how} (from "
        assert sum(line.startswith(said) for line in server.told) == 1, server.told
    assert re.search(r"\n  refused  \d+ no mac, \d+ wrong mac\n"
                     r"  no mac: senders that call themselves node 9 \(\d+ frames\)\n"
                     r"  wrong mac: senders that call themselves node 11, 12, 13 \(\d+ frames\)\n$", server.said), server.said


if __name__ == "__main__":
    sys.exit(main())
