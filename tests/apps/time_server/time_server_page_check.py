# SPDX-License-Identifier: Apache-2.0
"""docs/time_server_json.md has every member of every line of JSON, in the table of its event.
time_server_page_check.py BUILD_FOLDER [CASE...]"""
import pathlib
import re
import sys
import time

sys.path[:0] = [str(pathlib.Path(__file__).parent), str(pathlib.Path(__file__).parent.parent)]
from cases import BUILD, case, main

from node_runs import Keys, Server, ended, start_node
from served import CLIENT, client

ROOT = pathlib.Path(__file__).resolve().parents[3]
PAGE = (ROOT / "docs/time_server_json.md").read_text()
BARE = {"key_replaced", "key_unreadable"}  # whose event says it all
RARE = {"host_event": {"kind", "at_ns", "by_ms"}, "missed": {"lines"}, "clock": set()}  # not brought about here
LATER = {"other_id", "version", "round_trip_ms", "curvature_ppm_per_s"}  # of other kinds of events, and of longer runs
NAME = re.compile(r"`(\w+)`")


def tables():
    """Of each event the members that the page lists under `| of ...`."""
    listed = {}
    for events, rows in re.findall(r"^\| of ([^|]*)\|[^\n]*\n\| --- \| --- \|\n((?:\|.*\n)+)", PAGE, re.M):
        members = {name for row in rows.splitlines() for name in NAME.findall(row.split("|")[1])}
        for event in NAME.findall(events):
            listed.setdefault(event, set()).update(members)
    return listed


def lines_of_a_lively_run(folder):
    """Nodes of both kinds, a wrong key, a step, a reboot, another key, and none that can be read."""
    keys = Keys(BUILD, folder)
    with Server(BUILD, lab_key=keys.lab) as server:
        nodes = [start_node(BUILD, server.node_port, i, "--seconds", 12, *words, key=keys.of(i)) for i, words in (
            (1, ("--battery-mv", 3700, "--step", "6:0.3")), (2, ("--clockless",)), (3, ("--reboot-at", 2)))]
        nodes.append(start_node(BUILD, server.node_port, 4, "--seconds", 2))
        with client() as one:
            one.sendto(CLIENT, ("127.0.0.1", server.ntp_port))
        time.sleep(11)
        keys.lab.rename(folder / "away")
        time.sleep(1.2)
        (folder / "away").unlink()
        Keys(BUILD, folder).lab.rename(keys.lab)
        time.sleep(1.2)
        for node in nodes:
            ended(node)
    return server.lines


@case
def every_member_of_every_line_stands_in_the_table_of_its_event(folder):
    listed, seen = tables(), {}
    for line in lines_of_a_lively_run(folder):
        seen.setdefault(line["event"], set()).update(set(line) - {"schema", "event"})
    for event, members in seen.items():
        assert members <= listed.get(event, set()), (event, members - listed.get(event, set()))
    missing = (set(listed) | BARE) - set(seen) - set(RARE)
    assert not missing, missing
    for event, members in seen.items():  # what is listed is printed, too
        only = listed.get(event, set()) - members - LATER
        assert not only, (event, only)
    for event, members in RARE.items():
        assert members <= listed[event], event


if __name__ == "__main__":
    sys.exit(main())
