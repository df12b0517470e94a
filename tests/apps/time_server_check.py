# SPDX-License-Identifier: Apache-2.0
"""The time server asked by real clients, and by what is none. All traffic stays on loopback.
time_server_check.py BUILD_FOLDER [CASE...]"""
import fcntl
import os
import pathlib
import pty
import random
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
from cases import SANITIZED, Skip, case, kinalign, main, parsed

from node_runs import ended, start_node

ALL_ADDRESSES = ("--port", "0", "--local-stratum", "10")
CLIENT = bytes([0x23, 0, 6, 0x20]) + bytes(36) + b"\x01\x02\x03\x04\x05\x06\x07\x08"  # as chrony's
REFUSALS = ("too_short", "wrong_version", "wrong_mode", "wrong_trailer")


class Server:
    """The real program, until the end of the block; then `counts` is what it said last."""

    def __init__(self, *words, prefix=(), sign=signal.SIGTERM):
        self.sign = sign
        self.program = subprocess.Popen([*prefix, str(cases.PROGRAM), "time-server", *words, "--json"],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.program.stdout.readline()
        assert line, self.program.communicate()[1]
        self.started = parsed(line)
        self.port = self.started["port"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.program.send_signal(self.sign)
        out, self.err = self.program.communicate(timeout=30)
        assert self.program.returncode == 0, (self.program.returncode, self.err)
        self.counts = parsed(out.splitlines()[-1])
        assert self.counts["event"] == "stopped", out

    def memory_kib(self):
        status = pathlib.Path(f"/proc/{self.program.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1])


def client(family=socket.AF_INET, seconds=2.0):
    one = socket.socket(family, socket.SOCK_DGRAM)
    one.settimeout(seconds)
    return one


def ask(server, request, address="127.0.0.1"):
    """The answer to a request that is to have one."""
    with client(socket.AF_INET6 if ":" in address else socket.AF_INET) as one:
        one.sendto(request, (address, server.port))
        return one.recvfrom(2048)[0]


def needs(*programs):
    for program in programs:
        if not shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin:/sbin"):
            raise Skip(f"no {program}")


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


def has_ipv6_loopback():
    try:
        with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as one:
            one.bind(("::1", 0))
        return True
    except OSError:
        return False


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
    assert "clients are told not to follow it; with --local-stratum 10 they do, right or wrong" in server.err, server.err


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
def a_port_that_is_taken_is_named_with_what_to_do(_):
    with Server(*ALL_ADDRESSES) as server:
        done = kinalign("time-server", "--port", server.port)
    assert done.returncode == 3 and done.stdout == b"", done
    assert done.stderr.decode() == (
        f"kinalign time-server: 0.0.0.0:{server.port}: expected a UDP port to serve on, found another program on it\n"
        f"  ss -ulpn 'sport = :{server.port}' shows which one; --port takes another port\n"), done.stderr


@case
def advice_names_the_flag_of_the_port_that_failed(folder):
    with Server(*ALL_ADDRESSES) as server:
        done = kinalign("time-server", "--port", 0, "--node-port", server.port)
    advice = f"ss -ulpn 'sport = :{server.port}' shows which one; --node-port takes another port\n"
    assert done.returncode == 3 and done.stderr.decode().endswith(advice), done
    done = kinalign("time-server", "--port", 0, "--listen", "192.0.2.77")
    assert done.returncode == 3 and b"found no interface that has it" in done.stderr, done
    assert b"ip -brief address" in done.stderr and b"--listen takes one" in done.stderr, done
    node_key = folder / "node7.key"
    node_key.write_text("ab" * 16 + "\n")
    node_key.chmod(0o600)
    for key, found in ((node_key, "found 32 digits, a node's key"), (folder / "nope.key", "No such file or directory")):
        done = kinalign("time-server", "--port", 0, "--node-port", 0, "--lab-key", key)
        assert done.returncode == 3 and found in done.stderr.decode(), done
        advice = "--lab-key takes the lab's own file" if key is node_key else "--new-lab-key FILE makes one, where"
        assert advice in done.stderr.decode(), done
    done = kinalign("time-server", "--port", 0, "--node-port", 0, "--lab-key", "")
    assert done.returncode == 2 and b"--lab-key: expected a file's name, found nothing" in done.stderr, done


@case
def a_node_that_sends_to_the_ntp_port_is_told_once(_):
    with Server(*ALL_ADDRESSES) as server:
        ended(start_node(cases.BUILD, server.port, 7, "--seconds", 1))
    assert server.counts["from_node"] >= 10 and server.counts["wrong_trailer"] == 0, server.counts
    assert server.err.count("a node sends to the NTP port") == 1 and "--node-port" in server.err, server.err
    dated = r"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ kinalign time-server: warning: a node sends .*\n"
    assert re.fullmatch(dated, server.err), server.err


@case
def port_123_without_rights_is_refused_with_what_to_do(_):
    least = int(pathlib.Path("/proc/sys/net/ipv4/ip_unprivileged_port_start").read_text())
    if least <= 123:
        raise Skip("this machine lets anybody serve on port 123")
    needs("setpriv")
    prefix = ("setpriv", "--reuid", "65534", "--clear-groups") if os.getuid() == 0 else ()
    done = kinalign("time-server", prefix=prefix)
    assert done.returncode == 3 and done.stdout == b"", done
    lines = done.stderr.decode().splitlines()
    assert lines[0] == ("kinalign time-server: 0.0.0.0:123: expected a UDP port to serve on, "
                        "found no permission for a port below 1024"), lines
    assert "setcap" in lines[1] and "--port" in lines[2], lines


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


@case
def ctrl_c_term_and_a_closed_terminal_end_it_with_exit_code_0_and_its_counts(_):
    for sign in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        with Server(*ALL_ADDRESSES, sign=sign) as server:
            ask(server, CLIENT)
        assert server.counts["answered"] == 1 and server.err == "", (server.counts, server.err)


@case
def under_nohup_a_closed_terminal_does_not_end_it(_):
    with Server(*ALL_ADDRESSES, prefix=("nohup",)) as server:
        server.program.send_signal(signal.SIGHUP)
        time.sleep(0.5)
        assert len(ask(server, CLIENT)) == 48
    assert server.counts["answered"] == 1, server.counts


@case
def people_are_told_where_it_serves_what_clients_need_and_what_was_done(_):
    with subprocess.Popen([str(cases.PROGRAM), "time-server", "--port", "0", "--listen", "127.0.0.1",
                           "--local-stratum", "12"], stdout=subprocess.PIPE, text=True) as program:
        first = [program.stdout.readline() for _ in range(4)]
        program.send_signal(signal.SIGINT)
        last = program.stdout.read()
        assert program.wait(30) == 0
    port = re.fullmatch(r"serving time on 127\.0\.0\.1:(\d+), UDP\n", first[0])[1]
    assert "stratum" in first[1] and first[2] == f"  clients  chrony: server 127.0.0.1 port {port} iburst\n", first
    assert re.fullmatch(r"served for [\d.]+ m?s: 0 NTP requests answered\n", last), last


@case
def what_clients_are_told_can_be_typed_into_their_settings(_):
    for listen in ("0.0.0.0", "::"):
        if listen == "::" and not has_ipv6_loopback():
            continue
        with subprocess.Popen([str(cases.PROGRAM), "time-server", "--port", "0", "--listen", listen],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as program:
            host = [program.stdout.readline() for _ in range(3)][2].split()[3]
            program.terminate()
            program.communicate()
        assert host != listen and re.fullmatch(r"[\d.]+|[0-9a-f:]+|ADDRESS", host), host


@case
def a_terminal_shows_the_counts_in_one_line_that_is_gone_at_the_end(_):
    terminal, end = pty.openpty()
    with subprocess.Popen([str(cases.PROGRAM), "time-server", *ALL_ADDRESSES], stderr=end, stdout=subprocess.PIPE,
                          text=True, env={**os.environ, "TERM": "xterm"}) as program:
        program.stdout.readline()
        os.close(end)
        shown = ""
        while "serving: 0 NTP requests answered" not in shown:  # asked four times a second
            shown += os.read(terminal, 4096).decode()
        program.send_signal(signal.SIGTERM)
        assert program.stdout.read().endswith(": 0 NTP requests answered\n") and program.wait(30) == 0
        shown += os.read(terminal, 4096).decode()
    assert shown.count("\n") == 0 and shown.endswith("\r\x1b[K"), repr(shown)


@case
def on_a_terminal_json_stands_alone(_):
    terminal, end = pty.openpty()
    with subprocess.Popen([str(cases.PROGRAM), "time-server", *ALL_ADDRESSES, "--json"], stderr=end, stdout=end,
                          env={**os.environ, "TERM": "xterm"}) as program:
        shown = os.read(terminal, 4096)
        time.sleep(1)  # in which a status line would be drawn four times
        program.send_signal(signal.SIGTERM)
        assert program.wait(30) == 0
        shown += os.read(terminal, 4096)
        os.close(end)
    events = [parsed(line)["event"] for line in shown.decode().splitlines()]
    assert events == ["started", "stopped"], shown


@case
def the_help_and_the_page_name_every_kind_of_line(_):
    page = (pathlib.Path(__file__).parents[2] / "docs/time_server.md").read_text()
    table = page.split("| event | |\n| --- | --- |\n")[1].split("\n\n")[0]
    listed = {name for row in table.splitlines() for name in re.findall(r"`(\w+)`", row.split("|")[1])}
    assert len(listed) >= 12, listed
    told = re.split(r"[^\w]+", kinalign("time-server", "--help").stdout.decode())
    assert not listed - set(told), listed - set(told)
    source = "".join(path.read_text() for path in pathlib.Path(__file__).parents[2].glob("apps/kinalign/*.cpp"))
    made = set(re.findall(r'"event"[,:] "(\w+)"', source))
    assert {"node", "pair", "key_replaced", "missed"} <= made and not made - listed, made - listed


@case
def wrong_use_is_told_before_anything_is_served(_):
    cases.wrong("time-server", "--exempt", "lab",
                says="--exempt: expected an address or a network as 192.168.7.0/24, found lab")
    cases.wrong("time-server", "--port", "65536", says="--port: expected a whole number from 0 to 65535, found 65536")
    cases.wrong("time-server", "--local-stratum", "16",
                says="--local-stratum: expected a whole number from 1 to 15, found 16")
    cases.wrong("time-server", "--listen", "localhost",
                says="--listen: expected an IPv4 or IPv6 address, found localhost")
    for one, other, says in (("127.0.0.1", "127.0.0.1", "each address once, found 127.0.0.1 twice"),
                             ("::1", "0:0::1", "each address once, found ::1 twice"),
                             ("127.0.0.1", "0.0.0.0", "nothing that 0.0.0.0 stands for already, found 127.0.0.1"),
                             ("::", "::1", "nothing that :: stands for already, found ::1")):
        cases.wrong("time-server", "--listen", one, "--listen", other, says=f"--listen: expected {says}")
    cases.wrong("time-server", "--port", "12399", "--node-port", "12399",
                says="--node-port: expected another port than --port, found 12399: both flags name the same port")


if __name__ == "__main__":
    sys.exit(main())
