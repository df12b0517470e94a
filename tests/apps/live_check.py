# SPDX-License-Identifier: Apache-2.0
"""pose, denoise and fuse on what record receives: the real programs together, over loopback.
live_check.py BUILD_FOLDER [CASE...]"""
import contextlib
import json
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
from bvh_places import bvh_places
from cases import Skip, case, done_with, in_time, kinalign, main
from mcap_walk import MAGIC, Walk, records, text
from recording_program import free_port
from rehearsing import drawn_ports

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECONDS = 9
KEPT = {}
KEPT_FOLDER = tempfile.TemporaryDirectory(prefix="kinalign apps ")


def started(*words):
    return subprocess.Popen([str(cases.PROGRAM), *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            text=True)


@contextlib.contextmanager
def lab(folder, seconds=SECONDS):
    """Simulated devices, and record, which serves them on a port: the port, and record. It has ended behind this."""
    with subprocess.Popen([str(cases.PROGRAM), "simulate", "built-in", "-o", str(folder / "r"), "--live", "--begin-in",
                           "2", "--seconds", str(seconds), "--quiet", *drawn_ports()]) as simulation:
        while not (folder / "r/lab.toml").exists():
            assert simulation.poll() is None, simulation.returncode
            time.sleep(0.05)
        said = folder / "record.json"  # a pipe that nobody reads would lose lines
        with said.open("w") as out, subprocess.Popen(
                [str(cases.PROGRAM), "record", "-o", str(folder / "takes"), "--config", str(folder / "r/lab.toml"),
                 "--seconds", str(seconds + 2.5), "--compression", "none", "--json", "--live-port", "0"],
                stdout=out, stderr=subprocess.DEVNULL) as record:
            while "\n" not in said.read_text():
                assert record.poll() is None, record.returncode
                time.sleep(0.05)
            yield json.loads(said.read_text().splitlines()[0])["live_port"], record
            record.wait(60)
        simulation.wait(30)


def last_line(path):
    return json.loads(path.read_text().splitlines()[-1])


def heard(port, into):
    """All that a client of the port gets."""
    with socket.create_connection(("127.0.0.1", port)) as client:
        while piece := client.recv(1 << 16):
            into.append(piece)


@contextlib.contextmanager
def served(data):
    """A server that says `data` to one client, and ends: its port."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        def serve():
            client = server.accept()[0]
            with client, contextlib.suppress(OSError):
                client.sendall(data)
                client.shutdown(socket.SHUT_WR)
                client.recv(1)
        threading.Thread(target=serve, daemon=True).start()
        yield server.getsockname()[1]


def one_lab():
    """One run for all cases that only look at it: what clients said, record's end, the bytes of the stream."""
    if KEPT:
        return KEPT
    folder = pathlib.Path(KEPT_FOLDER.name)
    for name in ("pose", "denoise", "fuse"):
        if not (ROOT / f"models/{name}.safetensors").exists():
            raise Skip("no models")
    stream = []
    with lab(folder) as (port, record):
        listener = threading.Thread(target=heard, args=(port, stream))
        listener.start()
        stalled = socket.create_connection(("127.0.0.1", port))
        clients = {verb: started(verb, "--live", port, "--json", "-o", folder / f"{verb}.bvh")
                   for verb in ("pose", "denoise", "fuse")}
        clients = {verb: (client, *client.communicate(timeout=60)) for verb, client in clients.items()}
        record.wait(60)
        stalled.close()
        listener.join(20)
    events = {verb: [json.loads(line) for line in said.splitlines()] for verb, (_, said, _) in clients.items()}
    KEPT.update(folder=folder, events=events, codes={verb: client[0].returncode for verb, client in clients.items()},
                errors={verb: client[2] for verb, client in clients.items()}, stream=b"".join(stream),
                stopped=last_line(folder / "record.json"), code=record.returncode)
    return KEPT


def about_hips(path):
    """Joints about the middle of both hips, in directions of the world."""
    names, places = bvh_places(path)
    hips = [names.index(name) for name in (("lfemur", "rfemur") if "lfemur" in names else ("HipLeft", "HipRight"))]
    return places - places[:, hips].mean(1, keepdims=True)


def apart_cm(live, file):
    """Mean distance of joints; the files' grids may begin some frames apart, so the nearest shift counts."""
    a, b = about_hips(live), about_hips(file)
    best = None
    for shift in range(-20, 21):
        one, other = a[max(shift, 0):], b[max(-shift, 0):]
        frames = min(len(one), len(other))
        distance = 100 * numpy.linalg.norm(one[:frames] - other[:frames], axis=-1).mean()
        best = distance if best is None else min(best, distance)
    return best


@case
def what_is_answered_live_lies_near_what_is_answered_to_the_recording(folder):
    """The live answer sees two later frames, the file's 26 to 34 and all headings from both sides; the live clock's
    stamps and those of the whole recording differ by less than 5 ms. Pose over seeds 1 to 3: 0.6 to 0.7 cm apart."""
    run = one_lab()
    recording = run["folder"] / "takes/take_01.mcap"
    for verb, most in (("pose", 2.0), ("denoise", 2.0), ("fuse", 4.0)):
        assert run["codes"][verb] in (0, 1), (verb, run["errors"][verb])
        done = kinalign(verb, recording, "-o", folder / f"{verb}_file.bvh")
        assert done.returncode in (0, 1), done.stderr
        distance = apart_cm(run["folder"] / f"{verb}.bvh", folder / f"{verb}_file.bvh")
        assert distance < most, (verb, distance)


@case
def each_frame_is_a_line_and_the_last_line_says_how_late_they_came(_):
    run = one_lab()
    for verb, events in run["events"].items():
        frames = [event for event in events if event["event"] == "frame"]
        ended = events[-1]
        assert ended["event"] == "ended" and ended["ended"] == "record", (verb, ended)
        assert len(frames) > 30 * (SECONDS - 3) and ended["look_ahead"] == 2, (verb, len(frames))
        steps = numpy.diff([frame["time_ns"] for frame in frames])
        assert abs(steps - 1e9 / 30).max() < 2, (verb, steps)
        assert {len(row) for row in frames[0]["positions"]} == {3}, frames[0]
        assert {len(row) for row in frames[0]["local_rotations"]} == {4}, frames[0]
        turns = numpy.array(frames[-1]["local_rotations"])
        assert abs((turns ** 2).sum(1) - 1).max() < 1e-3, turns
        late = ended["latency_ms"]
        assert 0 < late["behind_motion_p50"] and late["frames"] > 60, (verb, late)
        in_time(late["behind_motion_p50"] < 5000, (verb, late))


@case
def a_client_that_does_not_read_costs_the_recording_nothing(_):
    run = one_lab()
    stopped = run["stopped"]
    assert stopped["event"] == "stopped" and stopped["dropped"] == 0, stopped
    assert stopped["live"]["clients"] == 5 and stopped["live"]["turned_away"] == 0, stopped["live"]
    walk = Walk(run["folder"] / "takes/take_01.mcap")
    assert walk.closed
    for topic in {message[0] for message in walk.messages if message[0].endswith("/raw")}:
        sequence = [message[1] for message in walk.messages if message[0] == topic]
        assert sequence == list(range(sequence[0], sequence[0] + len(sequence))), topic


@case
def the_stream_is_an_mcap_file_of_what_the_recording_has(_):
    run = one_lab()
    stream = run["stream"]
    assert stream[:8] == MAGIC and stream[-8:] == MAGIC
    topics, compared = {}, []
    stored = {message[:2]: message[2:] for message in Walk(run["folder"] / "takes/take_01.mcap").messages}
    for op, content in records(stream, 8):
        if op == 0x04:
            topics[struct.unpack_from("<H", content)[0]] = text(content, 4)[0]
        elif op == 0x05:
            channel, number, log, publish = struct.unpack_from("<HIQQ", content)
            if (topics[channel], number) in stored:
                compared.append((stored[topics[channel], number], (log, publish, content[22:])))
    assert len(compared) > 1000 and all(one == other for one, other in compared)


@case
def streams_that_are_none_are_named(_):
    run = one_lab()
    good = run["stream"]
    at = 8  # of a record in the middle: its opcode and length
    for _, content in records(good, 8):
        if at > len(good) // 2:
            break
        at += 9 + len(content)
    damaged = bytearray(good)
    damaged[at:at + 9] = b"\xff" * 9
    for data, says in ((b"HTTP/1.1 200 OK\r\n\r\n", "found another beginning"), (b"", "ended before it began"),
                       (bytes(damaged), "expected the stream of kinalign record --live-port"),
                       (good[:8] + b"\x05" + b"\xff" * 8 + good[8:], "expected the stream of kinalign record")):
        with served(data) as port:
            done = kinalign("pose", "--live", port)
            assert done.returncode == 3 and says in done.stderr.decode(), (says, done.stderr)


@case
def a_stream_that_breaks_off_gives_what_came_and_says_so(folder):
    run = one_lab()
    with served(run["stream"][:len(run["stream"]) * 3 // 4]) as port:
        out = done_with(1, "pose", "--live", port, "-o", folder / "part.bvh")[0]
    assert "the stream broke off" in out and "T-pose of" in out, out
    assert (folder / "part.bvh").exists()


@case
def nobody_who_serves_is_told_and_a_file_beside_live_is_wrong_use(_):
    port = free_port()
    done = kinalign("pose", "--live", port)
    assert done.returncode == 3 and b"nobody who serves there" in done.stderr, done.stderr
    for words in (("pose", "take.h5", "--live", port), ("fuse", "--look-ahead", 3, "take.h5", "-o", "x.bvh"),
                  ("denoise",), ("pose", "--live", "0")):
        done = kinalign(*words)
        assert done.returncode == 2, (words, done.returncode, done.stderr)


@case
def a_client_that_says_something_is_turned_away(folder):
    with lab(folder, 3) as (port, _):
        with socket.create_connection(("127.0.0.1", port)) as client:
            client.sendall(b"GET / HTTP/1.1\r\n\r\n")
            client.settimeout(10)
            with contextlib.suppress(ConnectionResetError):
                while client.recv(1 << 16):
                    pass
    stopped = last_line(folder / "record.json")
    assert stopped["live"]["turned_away"] == 1, stopped


sys.exit(main())
