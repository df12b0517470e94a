# SPDX-License-Identifier: Apache-2.0
"""What the time server says to who starts it: of its use, its port, its clients, its end.
time_server_words_check.py BUILD_FOLDER [CASE...]"""
import os
import pathlib
import pty
import re
import signal
import subprocess
import sys
import time

sys.path[:0] = [str(pathlib.Path(__file__).parent), str(pathlib.Path(__file__).parent.parent)]
import cases
from cases import Skip, case, kinalign, main, parsed

from node_runs import ended, start_node
from served import ALL_ADDRESSES, CLIENT, Server, ask, has_ipv6_loopback, needs


@case
def a_port_that_is_taken_is_named_with_what_to_do(_):
    with Server(*ALL_ADDRESSES) as server:
        done = kinalign("time-server", "--port", server.port)
    assert done.returncode == 3 and done.stdout == b"", done
    assert done.stderr.decode() == (
        f"kinalign time-server: 0.0.0.0:{server.port}: expected a UDP port to serve on, found a port that another program uses\n"
        f"  ss -ulpn 'sport = :{server.port}' shows which program uses it, perhaps another kinalign; --port sets another port\n"), done.stderr


@case
def advice_names_the_flag_of_the_port_that_failed(folder):
    with Server(*ALL_ADDRESSES) as server:
        done = kinalign("time-server", "--port", 0, "--node-port", server.port)
    advice = f"ss -ulpn 'sport = :{server.port}' shows which program uses it, perhaps another kinalign; --node-port sets another port\n"
    assert done.returncode == 3 and done.stderr.decode().endswith(advice), done
    done = kinalign("time-server", "--port", 0, "--listen", "192.0.2.77")
    assert done.returncode == 3 and b"found no network interface with this address" in done.stderr, done
    assert b"ip -brief address" in done.stderr and b"--listen accepts any of them" in done.stderr, done
    node_key = folder / "node7.key"
    node_key.write_text("ab" * 16 + "\n")
    node_key.chmod(0o600)
    for key, found in ((node_key, "found 32 digits, a node's key"), (folder / "nope.key", "No such file or directory")):
        done = kinalign("time-server", "--port", 0, "--node-port", 0, "--lab-key", key)
        assert done.returncode == 3 and found in done.stderr.decode(), done
        advice = "--lab-key needs the lab's own key file" if key is node_key else "--new-lab-key FILE makes the lab's key, if"
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
def a_disk_that_is_full_is_told_while_it_serves(_):
    with open("/dev/full", "w", encoding="utf-8") as full:
        server = subprocess.Popen([cases.PROGRAM, "time-server", *ALL_ADDRESSES, "--json"], stdout=full,
                                  stderr=subprocess.PIPE, text=True)
        line = server.stderr.readline()
        assert line.endswith("warning: standard output is blocked (No space left on device): up to 1 MiB of lines is kept; serving continues\n"), line
        assert server.poll() is None
        server.send_signal(signal.SIGTERM)
        assert "expected room to write, found No space left" in server.communicate(timeout=30)[1]
    assert server.returncode == 3


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
    lines = shown.decode().splitlines()
    assert all(line.startswith("{") for line in lines), shown
    events = [parsed(line)["event"] for line in lines]
    assert events == ["started", "stopped"], shown


@case
def the_help_and_the_page_name_every_kind_of_line(_):
    page = (pathlib.Path(__file__).parents[3] / "docs/time_server_json.md").read_text()
    table = page.split("| event | |\n| --- | --- |\n")[1].split("\n\n")[0]
    listed = {name for row in table.splitlines() for name in re.findall(r"`(\w+)`", row.split("|")[1])}
    assert len(listed) >= 12, listed
    told = re.split(r"[^\w]+", kinalign("time-server", "--help").stdout.decode())
    assert not listed - set(told), listed - set(told)
    others = ("live", "record", "simulate")  # verbs that tell events of their own
    sources = [path for path in pathlib.Path(__file__).parents[3].glob("apps/**/*.cpp")
               if path.parent.name not in others and not path.name.startswith((*others, "answer_output"))]
    source = "".join(path.read_text() for path in sources)
    made = set(re.findall(r'"event"[,:] "(\w+)"', source))
    assert {"node", "pair", "key_replaced", "missed"} <= made and not made - listed, made - listed


@case
def wrong_use_is_told_before_anything_is_served(_):
    cases.wrong("time-server", "--exempt", "lab",
                says="--exempt: expected an address or a network, such as 192.168.7.0/24, found lab")
    cases.wrong("time-server", "--port", "65536", says="--port: expected a whole number from 0 to 65535, found 65536")
    cases.wrong("time-server", "--local-stratum", "16",
                says="--local-stratum: expected a whole number from 1 to 15, found 16")
    cases.wrong("time-server", "--listen", "localhost",
                says="--listen: expected an IPv4 or IPv6 address, found localhost")
    for one, other, says in (("127.0.0.1", "127.0.0.1", "each address once, found 127.0.0.1 twice"),
                             ("::1", "0:0::1", "each address once, found ::1 twice"),
                             ("127.0.0.1", "0.0.0.0", "no address that 0.0.0.0 already includes, found 127.0.0.1"),
                             ("::", "::1", "no address that :: already includes, found ::1")):
        cases.wrong("time-server", "--listen", one, "--listen", other, says=f"--listen: expected {says}")
    cases.wrong("time-server", "--port", "12399", "--node-port", "12399",
                says="--node-port: expected a port other than that of --port, found port 12399 for both")


if __name__ == "__main__":
    sys.exit(main())
