# SPDX-License-Identifier: Apache-2.0
"""Recordings as npm's @mcap/core reads them, whole, cut and recovered.
mcap_core_check.py BUILD_FOLDER [CASE...]"""
import json
import pathlib
import random
import socket
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
from cases import case, kinalign, main
from mcap_core import core
from mcap_walk import whole_chunks
from recording_program import first_event

CUTS = 400


def recording(folder, *words):
    """Two seconds of two devices."""
    program = subprocess.Popen(
        [str(cases.PROGRAM), "record", "-o", str(folder), "--json", "--device", "mocap=noitom:udp:127.0.0.1:0",
         "--device", "kinect=kinect:udp:127.0.0.1:0", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    started = first_event(program)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        for i in range(200):
            for name, size in (("mocap", 1480), ("kinect", 700)):
                one.sendto(random.Random(i).randbytes(size), ("127.0.0.1", started["ports"][name]))
            time.sleep(0.01)
    time.sleep(0.1)
    program.terminate()
    _, err = program.communicate(timeout=60)
    assert program.returncode == 1, err  # rubbish is recorded, and told
    return pathlib.Path(started["file"])


def ours(path):
    done = kinalign("info", path, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@case
def a_whole_recording_is_read_from_front_to_end_and_by_its_index(folder):
    for words in ((), ("--compression", "none")):
        path = recording(folder / "-".join(("t", *words)), *words)
        stream, = core("stream", path)
        indexed, = core("indexed", path)
        count = ours(path)["messages"]
        assert count >= 400 and stream.get("done") is True, stream.get("error")
        assert len(stream["messages"]) == len(indexed["messages"]) == indexed["counted"] == count, indexed.get("error")
        assert sorted(stream["messages"]) == sorted(indexed["messages"])


@case
def a_recording_cut_anywhere_is_read_up_to_there_and_by_its_index_once_recovered(folder):
    path = recording(folder / "t")
    data = path.read_bytes()
    draw = random.Random(5)
    cuts = sorted(draw.sample(range(9, len(data)), CUTS - 1)) + [len(data)]
    whole = core("stream", path)[0]["messages"]
    chunks = whole_chunks(data)
    assert len(chunks) >= 6 and sum(messages for _, messages in chunks) == len(whole), chunks
    counts = []
    for cut, read in zip(cuts, core("stream", path, *cuts)):
        assert "error" not in read, (cut, read["error"])
        assert read["messages"] == whole[:len(read["messages"])], cut
        assert len(read["messages"]) >= sum(messages for end, messages in chunks if end <= cut), cut
        counts.append(len(read["messages"]))
    assert counts == sorted(counts) and counts[-1] == len(whole)
    for cut, count in list(zip(cuts, counts))[:: CUTS // 20]:
        torn, mended = folder / f"{cut}.mcap", folder / f"{cut}.whole.mcap"
        torn.write_bytes(data[:cut])
        done = kinalign("recover", torn, "-o", mended)
        if done.returncode == 3:  # cut before its metadata
            assert count == 0 and b"found none" in done.stderr and cut < chunks[0][0], (cut, done.stderr)
            continue
        assert done.returncode in (0, 1), done.stderr
        indexed, = core("indexed", mended)
        assert "error" not in indexed, (cut, indexed["error"])
        assert len(indexed["messages"]) == indexed["counted"] >= count, cut
        assert indexed["counted"] == ours(torn)["messages"], "we and it read the same"


if __name__ == "__main__":
    sys.exit(main())
