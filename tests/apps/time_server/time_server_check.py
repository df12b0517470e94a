# SPDX-License-Identifier: Apache-2.0
"""The time server asked by real clients, and by what is none. All traffic stays on loopback.
time_server_check.py BUILD_FOLDER [CASE...]"""
import fcntl
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import time

sys.path[:0] = [str(pathlib.Path(__file__).parent), str(pathlib.Path(__file__).parent.parent)]
import cases
from cases import SANITIZED, Skip, case, main, parsed

from node_runs import ended, start_node
from served import ALL_ADDRESSES, CLIENT, Server, ask, client, has_ipv6_loopback, needs

REFUSALS = ("too_short", "wrong_version", "wrong_mode", "wrong_trailer")


def said_by(*words, seconds=30):
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"
    done = subprocess.run(words, capture_output=True, text=True, timeout=seconds, check=False,
                          env={**os.environ, "PATH": path})
    return done.stdout + done.stderr


def chrony_once(server, address, seconds=8):
    """chronyd's one-shot query, which touches no clock."""
    needs("chronyd")
    return said_by("chronyd", "-Q", "-t", str(seconds), "-f", "/dev/null",
                   f"server {address} port {server.port} iburst maxsamples 1")


@case
def chrony_takes_the_time_over_ipv4_and_finds_this_clock_right(_):
    with Server(*ALL_ADDRESSES) as server:
        said = chrony_once(server, "127.0.0.1")
    found = re.search(r"System clock wrong by (-?[\d.]+) seconds", said)
    assert found and abs(float(found[1])) < 0.01, said
    assert server.counts["answered"] >= 1 and server.counts["received"] == server.counts["answered"], server.counts


@case
def chrony_takes_the_time_over_ipv6(_):
    if not has_ipv6_loopback():
        raise Skip("no IPv6 on loopback")
    with Server(*ALL_ADDRESSES) as server:
        said = chrony_once(server, "::1")
    assert "System clock wrong by" in said, said


@case
def chrony_as_a_daemon_selects_the_server_and_goes_on_asking(folder):
    needs("chronyd")
    with Server(*ALL_ADDRESSES) as server:
        (folder / "conf").write_text(f"server 127.0.0.1 port {server.port} iburst minpoll 0 maxpoll 2\n"
                                     f"port 0\ncmdport 0\npidfile chronyd.pid\nbindcmdaddress /\n")
        daemon = subprocess.Popen([shutil.which("chronyd", path="/usr/sbin:/usr/bin"), "-x", "-n", "-d",
                                   "-u", "root" if os.getuid() == 0 else os.environ.get("USER", "nobody"),
                                   "-f", "conf"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  text=True, cwd=folder)  # its settings can quote no folder with a blank
        time.sleep(8)
        daemon.terminate()
        said, _ = daemon.communicate(timeout=20)
    assert "Selected source 127.0.0.1" in said, said
    assert server.counts["answered"] >= 6, server.counts
    assert server.counts["limited"] == server.counts["kissed"] == 0, server.counts


@case
def chrony_turns_away_from_a_clock_that_nothing_synchronises(_):
    with Server("--port", "0") as server:
        if server.started["leap"] != "unsynchronised":
            raise Skip("this machine's clock is synchronised")
        assert server.started["stratum"] == 16, server.started
        answer = ask(server, CLIENT)
        assert answer[0] == 0xe4 and answer[1] == 16, answer
        said = chrony_once(server, "127.0.0.1", seconds=3)
    assert "Timeout reached" in said and "wrong by" not in said, said
    assert "clients will not follow it; if the lab has no other clock, --local-stratum 10 makes them follow this one, right or wrong" in server.err, server.err


def own_network():
    """What starts a program in a network of its own, where port 123 is free."""
    for way in (["unshare", "-n"], ["unshare", "-rn"]):
        if shutil.which("unshare") and not subprocess.run([*way, "ip", "link", "set", "lo", "up"],
                                                          capture_output=True, check=False).returncode:
            return way
    raise Skip("no network of its own to be had (unshare -n): port 123 may be in use")


@case
def ntpdate_and_ntpdig_take_the_time_from_port_123(_):
    needs("ntpdate", "ntpdig", "ip")
    six = "ntpdig -j ::1;" if has_ipv6_loopback() else ""
    script = ("ip link set lo up; \"$0\" time-server --local-stratum 10 >&2 & sleep 1; PATH=$PATH:/usr/sbin;"
              f"ntpdate -q 127.0.0.1; ntpdig -j 127.0.0.1; {six} kill -INT $!; wait $!; echo ended with $?")
    said = said_by(*own_network(), "bash", "-c", script, str(cases.PROGRAM), seconds=60)
    assert re.search(r" 127\.0\.0\.1 s10 no-leap", said), said
    answers = [parsed(line) for line in said.splitlines() if line.startswith("{")]
    assert len(answers) == (2 if six else 1), said
    for answer in answers:
        assert answer["stratum"] == 10 and abs(answer["offset"]) < 0.01, answer
    assert "serving time on 0.0.0.0:123" in said and f"{2 + bool(six)} NTP requests answered" in said, said
    assert "ended with 0" in said, said


@case
def an_answer_has_48_bytes_and_the_client_s_own_stamp_and_version(_):
    with Server(*ALL_ADDRESSES, "--exempt", "127.0.0.1") as server:
        for version in (1, 2, 3, 4):
            for leap in range(4):
                request = bytes([leap << 6 | version << 3 | 3]) + CLIENT[1:]
                answer = ask(server, request)
                assert len(answer) == 48 and answer[0] == version << 3 | 4, answer
                assert answer[24:32] == CLIENT[40:], answer
        field = struct.pack(">HH", 0x104, 28) + bytes(24)
        for behind in (field, field + bytes(20), bytes(24), bytes(4)):
            assert len(ask(server, CLIENT + behind)) == 48
    assert server.counts["answered"] == 20, server.counts


@case
def an_answer_comes_from_the_address_that_was_asked(_):
    with Server(*ALL_ADDRESSES) as server, client() as one:
        for address in ("127.0.0.1", "127.0.0.9", "127.200.3.4"):
            one.sendto(CLIENT, (address, server.port))
            assert one.recvfrom(2048)[1] == (address, server.port)


@case
def a_request_of_a_wrong_mode_version_or_length_gets_no_answer_and_is_counted(_):
    wrong = [(bytes(n), "too_short") for n in range(48)]
    wrong += [(bytes([v << 3 | 3]) + CLIENT[1:], "wrong_version") for v in (0, 5, 6, 7)]
    wrong += [(bytes([0x20 | mode]) + CLIENT[1:], "wrong_mode") for mode in (0, 1, 2, 4, 5, 6, 7)]
    wrong += [(CLIENT + bytes(n - 48), "wrong_trailer") for n in (49, 64, 71, 1500, 65507)]
    wrong += [(b"\x17\x00\x03\x2a" + bytes(4), "too_short"),  # monlist of mode 7, as floods send it
              (b"\x17\x00\x03\x2a" + bytes(188), "wrong_mode"), (b"\x16\x01" + bytes(46), "wrong_mode")]
    with Server(*ALL_ADDRESSES, "--exempt", "127.0.0.1") as server, client() as one:
        for request, _ in wrong:
            one.sendto(request, ("127.0.0.1", server.port))
        one.sendto(CLIENT, ("127.0.0.1", server.port))
        assert len(one.recv(2048)) == 48
        one.settimeout(0.2)
        try:
            raise AssertionError(f"an answer to what is no request: {one.recv(2048)}")
        except TimeoutError:
            pass
    for name in REFUSALS:
        assert server.counts[name] == sum(cause == name for _, cause in wrong), (name, server.counts)
    assert server.counts["answered"] == 1 and server.counts["received"] == len(wrong) + 1, server.counts


@case
def garbage_makes_the_server_neither_fall_nor_grow(_):
    draw = random.Random(11)
    with Server(*ALL_ADDRESSES) as server, client() as one:
        before = server.memory_kib()
        sent = 0
        for _ in range(200):
            for _ in range(100):
                size = draw.choice((0, 1, 47, 48, 52, 68, 72, 100, 1472))
                one.sendto(draw.randbytes(size), (f"127.0.{draw.randrange(256)}.1", server.port))
                sent += 1
            time.sleep(0.005)
        grown = server.memory_kib() - before
        assert SANITIZED or grown < 2048, f"{grown} KiB more"  # the limit's table is touched: 1 MiB
    assert server.counts["received"] == sent, (sent, server.counts)


@case
def who_asks_too_often_is_limited_and_told_so_now_and_then(_):
    with Server(*ALL_ADDRESSES) as server, client() as one:
        for _ in range(8 + 32):
            one.sendto(CLIENT, ("127.0.0.1", server.port))
        answers = [one.recv(2048) for _ in range(10)]
    kisses = [a for a in answers if a[1] == 0]
    assert len(kisses) == 2 and all(a[12:16] == b"RATE" and a[24:32] == CLIENT[40:] for a in kisses), answers
    assert (server.counts["answered"], server.counts["kissed"], server.counts["limited"]) == (8, 2, 30), server.counts


@case
def a_reader_that_stops_reading_holds_up_nothing(_):
    with Server("--port", "0", "--listen", "127.0.0.1", "--local-stratum", "10",
                "--node-port", "0") as server:
        for pipe in (server.program.stdout, server.program.stderr):
            fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, 4096)
        nodes = [start_node(cases.BUILD, server.started["node_port"], node_id, "--seconds", 3)
                 for node_id in range(1, 9)]  # 8 lines of 400 bytes each second, and more on stderr
        for node in nodes:
            ended(node)
        for _ in range(4):
            ask(server, CLIENT)
    assert server.counts["answered"] == 4, server.counts


if __name__ == "__main__":
    sys.exit(main())
