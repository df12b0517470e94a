# SPDX-License-Identifier: Apache-2.0
"""What devices send stands in the recording, and what is said of it meanwhile.
record_check.py BUILD_FOLDER [CASE...]"""
import fcntl
import json
import os
import pathlib
import pty
import re
import select
import signal
import socket
import struct
import sys
import termios
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
from cases import case, in_time, kinalign, main
from mcap_walk import Walk
from node_runs import ended, start_node
from recording_program import Recording, Sender, frame, free_port, mark, numbers, send, sender_to


@case
def what_is_sent_stands_in_the_file_and_ctrl_c_closes_it(folder):
    recording = Recording(folder / "takes", "--subject", "03", "--action", "S1A02")
    with Sender(recording.port) as sender:
        time.sleep(1.5)
    time.sleep(0.2)
    code, events, err = recording.end()
    assert code == 0, err
    assert recording.path == folder / "takes/03_S1A02_01.mcap", recording.path
    assert events[-1]["event"] == "stopped" and events[-1]["dropped"] == 0, events[-1]
    assert any(event["event"] == "status" for event in events), events
    walk = Walk(recording.path)
    assert walk.closed
    assert walk.metadata["kinalign.recording"]["subject"] == "03", walk.metadata
    assert numbers(walk) == list(range(len(sender.sent))), "a message is missing"
    logs = [log for topic, _, log, *_ in walk.messages if topic == "/mocap/raw"]
    assert all(abs(log / 1e9 - time.time()) < 600 for log in logs), "log times are UTC"
    assert logs == sorted(logs)
    assert any(topic == "/clock/host" for topic, *_ in walk.messages)


@case
def a_take_is_never_overwritten(folder):
    paths = []
    for _ in range(3):
        recording = Recording(folder / "takes", "--seconds", "0")
        assert recording.program.wait(60) == 1, "its required device sent nothing"
        recording.program.communicate()
        paths.append(recording.path.name)
    assert paths == ["take_01.mcap", "take_02.mcap", "take_03.mcap"], paths


@case
def a_port_that_cannot_be_used_is_told_of_while_it_is_recorded(folder):
    recording = Recording(folder / "takes")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        for _ in range(2):
            one.sendto(b"CCCC\x28\0\0\0\x1f\x8b\x08\0" + b"Z" * 36, ("127.0.0.1", recording.port))
    said = recording.until("finding")[-1]
    assert "found compressed" in said["what"] and "switch the capture program" in said["repair"], said
    status = recording.until("status")[-1]
    while status["ports"]["mocap"]["pieces"] < 2:  # told between both
        status = recording.until("status")[-1]
    assert status["ports"]["mocap"]["dropped"] == 0, status
    code, events, err = recording.end()
    assert code == 1, err
    assert not any(event["event"] == "finding" for event in events), "told again"
    assert err.count("switch the capture program") == 1 and "\n\n" not in err, err


@case
def the_page_names_every_kind_of_line(_):
    root = pathlib.Path(__file__).parents[2]
    table = (root / "docs/recording_json.md").read_text().split("| event | |\n| --- | --- |\n")[1].split("\n\n")[0]
    listed = {name for row in table.splitlines() for name in re.findall(r"`(\w+)`", row.split("|")[1])}
    source = (root / "apps/kinalign/record/record_printer.cpp").read_text()
    made = set(re.findall(r'"(\w+)"', " ".join(re.findall(r'"event", ([^}]+)}', source))))
    words = (root / "apps/kinalign/text/node_event_text.cpp").read_text()  # time-server's, for the same
    made |= set(re.findall(r'"((?:host|node|clock)_event)"', words))
    assert made and made == listed, (made, listed)


@case
def wrong_use_is_said_before_anything_is_opened(folder):
    for words, says in (((), "--device: expected at least one device, or a lab.toml for --config, found none"),
                        (("--device", "imu=nodes"), "expected NAME=PROTOCOL:PORT, such as imu=nodes:5005, found imu=nodes"),
                        (("--device", "imu=node:5005"), 'expected a known protocol (nearest: nodes), found "node"'),
                        (("--device", "a=noitom:tcp:7001"), "expected an address and a port to connect to, found no address or no port"),
                        (("--device", "a=nodes:5005", "--wait"), "--wait: expected --marks-port, --trigger-port or a keyboard"),
                        (("--device", "a=nodes:5005", "--marks-port", "30", "--trigger-port", "30"),
                         "--trigger-port: expected another port than --marks-port, found 30"),
                        (("--device", "a=nodes:70000"), "expected a port from 0 to 65535, found 70000")):
        done = kinalign("record", "-o", folder / "takes", *words)
        assert done.returncode == 2 and says in done.stderr.decode(), done.stderr
    assert not (folder / "takes").exists()


BVH = """HIERARCHY
ROOT Hips
{
OFFSET 0 0 0
CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation
End Site
{
OFFSET 0 10 0
}
}
MOTION
"""


def example_of_the_page():
    page = (pathlib.Path(__file__).parents[2] / "docs/formats/lab_toml.md").read_text()
    return page.split("```toml\n")[1].split("```")[0]


@case
def the_pages_lab_records_and_stands_in_the_file_with_the_skeleton(folder):
    (folder / "rigs").mkdir()
    (folder / "rigs/lab59.bvh").write_text(BVH + "Frames: 1\nFrame Time: 0.008\n0 90 0 1 2 3\n")
    assert kinalign("node-key", "--new-lab-key", folder / "lab.key").returncode == 0
    lab = re.sub(r"port = (?!7001)\d+", "port = 0", example_of_the_page())  # the tests' machine has others
    assert lab.count("port = 0") >= 2, lab
    (folder / "lab.toml").write_text(lab)
    recording = Recording(folder / "takes", "--config", folder / "lab.toml", "--device", "kinect=kinect:udp:127.0.0.1:0",
                          device=None)
    ports = recording.started["ports"]
    assert list(ports) == ["mocap", "kinect", "imu"], ports
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.sendto(b"hello", ("127.0.0.1", ports["kinect"]))
        time.sleep(0.3)
    code, events, err = recording.end()
    assert code == 1 and sorted(events[-1]["missing"]) == ["imu Hips", "imu RightForeArm", "mocap"], (code, events[-1], err)
    walk = Walk(recording.path)
    assert walk.metadata["kinalign.devices"] == {"mocap": "required", "kinect": "required", "imu/7": "required",
                                                 "imu/12": "required"}, walk.metadata
    assert walk.attachments["lab.toml"].decode() == lab
    assert walk.attachments["mocap.bvh"].decode() == BVH + "Frames: 0\nFrame Time: 0.008\n"
    assert walk.channels["/kinect/raw"]["transport"] == "udp", "a flag wins over the file"


@case
def what_is_wrong_with_a_lab_is_told_with_its_line(folder):
    lab = folder / "lab.toml"
    for text, says in (('[device.mocap]\nprotocol = "noitm"\n', ':2: expected protocol as one of nodes, noitom'),
                       ('[device.mocap]\nprotocol = "noitom"\nprt = 1\n', ":3: expected a key of [device.mocap] (nearest: port)"),
                       ('[record]\npre_rol_s = 1\n', ":2: expected a setting of record (did you mean pre_roll_s?)"),
                       ('[device.mocap]\nprotocol = "noitom"\n', ":1: expected port to receive on (0: any free port), found no port"),
                       ('[align]\ngap_ms = 1\n', "--device: expected at least one device, or a lab.toml")):
        lab.write_text(text)
        done = kinalign("record", "-o", folder / "takes", "--config", lab)
        assert done.returncode == 2 and says in done.stderr.decode(), done.stderr
    lab.write_text('[device.mocap]\nprotocol = "noitom"\nport = 0\nskeleton = "none.bvh"\n')
    done = kinalign("record", "-o", folder / "takes", "--config", lab)
    assert done.returncode == 3 and f"{folder}/none.bvh: expected" in done.stderr.decode(), done.stderr
    assert not (folder / "takes").exists()


@case
def with_wait_a_take_begins_with_a_start_and_what_came_before_and_ends_with_a_stop(folder):
    recording = Recording(folder / "takes", "--wait", "--trigger-port", "0", "--marks-port", "0", first="waiting")
    ports = recording.started["ports"]
    mocap = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    mocap.sendto(frame(0), ("127.0.0.1", recording.port))
    time.sleep(0.3)
    assert not (folder / "takes").exists() or not list((folder / "takes").iterdir()), "nothing before the start"
    send(ports["marks"], '{"schema":"kinalign.mark/1","kind":"text","id":"1","text":"a word"}')
    send(ports["trigger"], '<CaptureStart><Name VALUE="dance"/><Delay VALUE="33"/><PacketID VALUE="1"/></CaptureStart>')
    said = recording.until("started")
    path = pathlib.Path(said[-1]["file"])
    marks = [event for event in said if event["event"] == "mark"]
    assert [mark["kind"] for mark in marks] == ["text", "start"], marks
    mocap.sendto(frame(1), ("127.0.0.1", recording.port))
    time.sleep(0.3)
    send(ports["trigger"], '<CaptureStop RESULT="SUCCESS"><PacketID VALUE="2"/></CaptureStop>')
    last = recording.until("stopped")[-1]
    assert recording.program.wait(30) == 0
    recording.program.communicate()
    mocap.close()
    trigger = last["ports"]["trigger"]
    assert (trigger["marks"], trigger["repeats"], trigger["refused_for"]) == (2, 0, {}), last
    walk = Walk(path)
    assert walk.closed and numbers(walk) == [0, 1], numbers(walk)
    in_file = [json.loads(payload) for topic, *_, payload in walk.messages if topic == "/marks"]
    assert [(m["kind"], m["source"], m.get("text")) for m in in_file] == [
        ("text", "call", "a word"), ("start", "trigger", "dance"), ("stop", "trigger", None)], in_file
    assert in_file[1]["latency_ms"] == 33


@case
def a_start_and_a_stop_that_come_together_are_a_take(folder):
    recording = Recording(folder / "takes", "--wait", "--marks-port", "0", first="waiting")
    for kind in ("stop", "start", "stop", "start"):
        mark(recording.started["ports"], kind)
    said = recording.until("stopped")
    assert recording.program.wait(30) == 1, "mocap sent nothing"
    recording.program.communicate()
    walk = Walk(pathlib.Path(said[-1]["files"][0]))
    marks = [json.loads(payload)["kind"] for topic, *_, payload in walk.messages if topic == "/marks"]
    assert marks[:3] == ["stop", "start", "stop"], marks


@case
def with_repeat_each_start_begins_a_take_of_its_own_until_ctrl_c(folder):
    recording = Recording(folder / "2026" / "takes", "--wait", "--repeat", "--marks-port", "0", "--pre-roll-s", "0",
                          first="waiting")
    ports, files = recording.started["ports"], []

    with sender_to(recording.port) as device:
        for take in range(2):
            if take > 0:
                recording.until("waiting")
                device(frame(9))  # between takes
                time.sleep(1)  # longer than a chunk of the pre-roll
            mark(ports, "start")
            recording.until("started")
            device(frame(take))
            time.sleep(0.2)
            mark(ports, "stop")
            files += recording.until("stopped")[-1]["files"]
    recording.until("waiting")
    code, _, err = recording.end()
    assert code == 0, err
    assert err.endswith("kinalign record: 2 takes\n"), err
    assert [pathlib.Path(file).name for file in files] == ["take_01.mcap", "take_02.mcap"], files
    found = [numbers(Walk(pathlib.Path(file))) for file in files]
    assert found == [[0], [1]], found


@case
def takes_by_marks_end_with_the_one_that_something_is_amiss_with(folder):
    recording = Recording(folder, "--wait", "--repeat", "--marks-port", "0", first="waiting")
    ports = recording.started["ports"]
    mark(ports, "start")
    recording.until("started")
    send(ports["marks"], '{"kind":"t_pose","latency_ms":4}')
    recording.until("finding")
    mark(ports, "stop")
    recording.until("waiting")
    with sender_to(recording.port) as device:  # nothing is amiss with this one
        mark(ports, "start")
        recording.until("started")
        device(frame(1))
        time.sleep(0.2)
        mark(ports, "stop")
    recording.until("waiting")
    code, _, err = recording.end()
    assert code == 1, err
    said = f"kinalign record: 2 takes; exit code 1 because of the messages above about {folder}/take_01.mcap\n"
    assert err.endswith(said), err


@case
def signals_that_come_one_upon_another_end_it_in_order(folder):
    recording = Recording(folder / "takes")
    with Sender(recording.port) as sender:
        time.sleep(0.3)
    for sign in (signal.SIGHUP, signal.SIGHUP, signal.SIGTERM, signal.SIGINT):
        recording.program.send_signal(sign)
    _, err = recording.program.communicate(timeout=30)
    walk = Walk(recording.path)
    assert recording.program.returncode == 0 and walk.closed, err
    assert numbers(walk) == list(range(len(sender.sent)))


@case
def ctrl_c_before_the_start_records_nothing_and_says_so(folder):
    recording = Recording(folder / "takes", "--wait", "--marks-port", "0", first="waiting")
    code, _, err = recording.end()
    assert code == 1 and "nothing was recorded" in err, (code, err)
    assert not list((folder / "takes").iterdir())


@case
def who_falls_silent_and_comes_back_is_told_once(folder):
    recording = Recording(folder / "takes", "--device", "kinect=kinect:udp:127.0.0.1:0")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.sendto(frame(0), ("127.0.0.1", recording.port))
        said = recording.until("silent")
        assert said[-1]["stream"] == "mocap", said[-1]
        status = recording.until("status")[-1]
        assert status["missing"] == ["mocap", "kinect"], status
        one.sendto(frame(1), ("127.0.0.1", recording.port))
        recording.until("returned")
        status = recording.until("status")[-1]
        in_time("mocap" not in status["missing"], status)
        assert status["free_bytes"] > 0, status
    code, events, err = recording.end()
    assert code == 1, err
    assert events[-1]["ports"]["mocap"]["pieces"] == 2 and events[-1]["missing"] == ["kinect"], events[-1]
    done = kinalign("check", recording.path, "--json")
    found = [(one["expected"], one["found"]) for one in json.loads(done.stdout)["findings"]]
    assert done.returncode == 1 and ("messages of kinect", "none") in found, found


@case
def a_node_that_is_not_heard_is_told_with_its_reason(folder):
    page = (pathlib.Path(__file__).parents[2] / "docs/formats/imu_node_example.md").read_text()
    rows = re.findall(r"^00[0-9a-f]{2}  ((?:[0-9a-f]{2} )*[0-9a-f]{2})", page.split("version 1, a frame")[0].rsplit("```text", 1)[1]
                      + page.split("version 1, a frame")[1].split("```")[0], re.M)
    frame = bytes.fromhex("".join(rows))
    assert len(frame) == 89, frame
    recording = Recording(folder / "takes", "--device", "imu=nodes:udp:127.0.0.1:0")
    send(recording.started["ports"]["imu"], frame)
    told = recording.until("node_event")[-1]
    assert (told["kind"], told["refusal"], told["node_id"]) == ("wrong_key", "no_key", 7), told
    code, _, err = recording.end()
    assert code == 1 and "to accept it, give the lab's key with --lab-key FILE" in err, err


@case
def what_is_no_mark_is_counted_on_the_screen_and_in_the_file(folder):
    recording = Recording(folder / "takes", "--marks-port", "0")
    send(recording.port, frame(0))
    send(recording.started["ports"]["marks"], "no mark")
    send(recording.started["ports"]["marks"], '{"schema":"kinalign.mark/1","kind":"text","id":"1","text":"a word"}')
    said = recording.until("mark")
    while not any(event["event"] == "finding" for event in said):
        said += recording.until("finding")
    found = next(event for event in said if event["event"] == "finding")
    assert "no mark" in found["what"] and found["severity"] == "note", found
    code, events, err = recording.end()
    assert code == 0, err
    assert events[-1]["ports"]["marks"]["refused"] == 1, events[-1]
    assert events[-1]["ports"]["marks"]["refused_for"] == {"bad_json": 1}, events[-1]
    told = json.loads(kinalign("info", recording.path, "--json").stdout)
    assert told["closed"] and told["dropped"] == 0, told
    assert [port["refused"] for port in told["ports"] if port["stream"] == "marks"] == [1], told
    assert [(mark["kind"], mark["text"]) for mark in told["marks"]] == [("text", "a word")], told
    assert [one["messages"] for one in told["senders"]] == [1], told
    text = kinalign("info", recording.path).stdout.decode()
    assert re.search(r"^  mark +text \S*a word\S* at \d+\.\d{3} s, by call$", text, re.M), text


@case
def a_node_has_one_name_while_it_is_recorded_and_afterwards(folder):
    (folder / "lab.toml").write_text('[device.imu]\nprotocol = "nodes"\nport = 0\naddress = "127.0.0.1"\n'
                                     'nodes = { "7" = "wrist", "9" = "waist" }\n')
    recording = Recording(folder / "takes", "--config", folder / "lab.toml", device=None)
    nodes = [start_node(cases.BUILD, recording.started["ports"]["imu"], i, "--seconds", 4) for i in (7, 3)]
    for node in nodes:
        ended(node)
    recording.until("silent")
    code, events, err = recording.end()
    assert code == 1 and events[-1]["missing"] == ["imu waist"], (code, events[-1])
    for said in (r"imu wrist: joined \(", r"imu 3: joined \(", "imu (wrist|3) from 127.* fell silent",
                 "imu waist: nothing has come to port"):
        assert re.search(f"^{said}", err, re.M), (said, err)
    info, check = (kinalign(verb, recording.path).stdout.decode() for verb in ("info", "check"))
    for said in ("imu wrist from 127", "imu 3 from 127"):
        assert re.search(f"^  sender +{said}", info, re.M), info
    assert "expected messages of imu waist, found none" in check, check
    for text in (err, re.sub(r"^  channel .*\n", "", info, flags=re.M), check):
        assert not re.search(r"node \d|imu/\d", text), text


class Terminal:
    """The program on a terminal of its own: what it shows, and keys for it."""

    def __init__(self, folder, *words):
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            os.execv(str(cases.PROGRAM), ["kinalign", "record", "-o", str(folder), "--compression", "none", *words])
        self.resize(160)
        self.shown = b""

    def resize(self, columns):
        fcntl.ioctl(self.fd, termios.TIOCSWINSZ, struct.pack("HHHH", 30, columns, 0, 0))

    def until(self, text):
        end = time.monotonic() + 60
        while text not in self.shown:
            assert time.monotonic() < end, self.shown[-2000:]
            if not select.select([self.fd], [], [], 1)[0]:
                continue
            try:
                self.shown += os.read(self.fd, 65536)
            except OSError:  # closed: the program has ended
                assert text in self.shown, self.shown[-2000:]

    def press(self, keys):
        os.write(self.fd, keys)

    def end(self):
        self.press(b"\x03")
        self.until(b"messages" if b"from" in self.shown else b".mcap\r\n")
        try:
            while more := os.read(self.fd, 65536):
                self.shown += more
        except OSError:
            pass
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])


@case
def on_a_terminal_a_table_stands_keys_make_marks_and_a_bell_rings_for_who_falls_silent(folder):
    port = free_port()
    screen = Terminal(folder / "takes", "--device", f"mocap=noitom:udp:127.0.0.1:{port}",
                      "--device", "kinect=kinect:udp:127.0.0.1:0")
    screen.until(b"recording to")
    send(port, frame(0))
    screen.until(b"127.0.0.1:")
    screen.until(b"\x1b[31mkinect missing: nothing yet")
    screen.until(b"Enter a text")
    screen.press(b"st\r")
    screen.until(b"text: ")
    screen.press("grüß".encode() + b"\re")
    screen.until(b"mark: stop, by keyboard")
    screen.until(b"\a")
    screen.until(b"fell silent")
    screen.until(b"left at this rate, ")
    assert screen.end() == 1, "nothing came of the Kinect"
    assert b"\x1b[A" in screen.shown, "the table is drawn over itself"
    assert b"\x1b[J" not in screen.shown, "tmux keeps a copy of the screen for each"
    walk = Walk(folder / "takes/take_01.mcap")
    assert walk.closed
    marks = [(json.loads(payload)["kind"], json.loads(payload).get("text"))
             for topic, *_, payload in walk.messages if topic == "/marks"]
    assert marks == [("start", None), ("t_pose", None), ("text", "grüß"), ("stop", None)], marks


ERASED = re.compile(rb"\r\x1b\[K((?:\x1b\[A\x1b\[K)+)")


def rows(shown, columns):
    """That lines take on a terminal so wide which breaks them anew."""
    lines = re.sub(r"\x1b\[\d+m", "", shown.decode()).split("\r\n")
    return sum(max(1, -(-len(line) // columns)) for line in lines)


@case
def the_table_stands_again_behind_each_message(folder):
    port = free_port()
    screen = Terminal(folder / "takes", "--device", f"mocap=noitom:udp:127.0.0.1:{port}")
    screen.until(b"Ctrl-C ends")
    send(port, frame(0))
    screen.until(b"rate/s")  # the head of the first table that has somebody
    screen.press(b"ste")
    screen.until(b"mark: stop, by keyboard")
    screen.until(b"silent 2 s")  # the table behind it: Ctrl-C throws away what the terminal holds
    assert screen.end() == 0
    for message in (b"mark: start", b"mark: t_pose", b"mark: stop", b"fell silent"):
        behind = re.split(rb"\r\n", screen.shown.partition(message)[2])[1:]
        assert behind[0].startswith(b"device") and b"Ctrl-C ends" in behind[3], behind
    assert re.search(rb"A\x1b\[K[^\r]*/take_01\.mcap\r\n  mocap from ", screen.shown), screen.shown[-1000:]
    assert b"device" not in ERASED.split(screen.shown)[-1], screen.shown[-1000:]


@case
def a_table_that_a_narrower_window_has_broken_anew_is_erased_whole(folder):
    screen = Terminal(folder / "takes", "--device", f"mocap=noitom:udp:127.0.0.1:{free_port()}")
    screen.until(b"Ctrl-C ends")
    screen.resize(30)
    screen.until(b"  t T-pose  En\r")  # what has room of the last line
    screen.resize(160)
    assert screen.end() == 1
    shown = ERASED.split(screen.shown)  # and how far up each time
    tables = [re.search(rb"mocap +missing.*|\Z", piece, re.S)[0] for piece in shown[:-1:2]]
    erased = [(rows(table, 160), rows(table, 30), up.count(b"A") + 1) for table, up in zip(tables, shown[1::2])]
    assert any(wide < broken == up for wide, broken, up in erased), erased


if __name__ == "__main__":
    sys.exit(main())
