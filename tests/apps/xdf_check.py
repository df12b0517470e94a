# SPDX-License-Identifier: Apache-2.0
"""What the verbs make of XDF files.
xdf_check.py BUILD_FOLDER [CASE...]"""
import math
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import Skip, case, done_with, main, parsed, refused, wrong
from mcap_core import core

MINIMAL = pathlib.Path(__file__).parents[2] / "../shared/data/xdf/minimal.xdf"


def chunk(tag, content):
    return b"\x04" + struct.pack("<IH", len(content) + 2, tag) + content


def stream(number, name, kind, channels, rate):
    return chunk(2, struct.pack("<I", number) + (
        f"<info><name>{name}</name><type>IMU</type><channel_count>{channels}</channel_count>"
        f"<nominal_srate>{rate}</nominal_srate><channel_format>{kind}</channel_format></info>").encode())


def sample(number, stamp, letter, *values):
    return chunk(3, struct.pack("<IBBBd", number, 1, 1, 8, stamp) + struct.pack(f"<{len(values)}{letter}", *values))


BEGIN = b"XDF:" + chunk(1, b"<info><version>1.0</version></info>")


@case
def info_and_check_know_an_XDF_and_its_torn_end(folder):
    whole = BEGIN + stream(7, "wrist", "double64", 1, 4) + chunk(4, struct.pack("<Idd", 7, 5.0, -0.25))
    for k in range(8):
        whole += sample(7, 5.0 + k / 4, "d", 0.5)
    path = folder / "rec.xdf"
    path.write_bytes(whole)
    out, _ = done_with(0, "info", path)
    assert "wrist (IMU): 1 channel of double64, 8 samples, 4 Hz nominal, 4 Hz by the stamps" in out, out
    streams = parsed(done_with(0, "info", path, "--json")[0])["streams"]
    assert [(s["name"], s["samples"], s["first_s"], s["last_s"]) for s in streams] == [("wrist", 8, 5.0, 6.75)], streams
    out, _ = done_with(0, "check", path)
    assert out == "1 file read, nothing found\n", out
    path.write_bytes(whole[:-5])
    out, _ = done_with(1, "check", path)
    assert out.startswith(f"warning  {path}: expected a last chunk of 25 bytes, found 20 bytes at byte "), out
    assert "1 finding: see kinalign check" in done_with(0, "info", path)[0]
    done_with(2, "info", path, "--rate-hz", "60")


@case
def convert_takes_an_XDF_whole_or_torn_and_writes_over_nothing(folder):
    path, shown = folder / "rec.xdf", folder / "rec.mcap"
    path.write_bytes(BEGIN + stream(7, "wrist", "double64", 1, 4) + sample(7, 5.0, "d", 0.5)
                     + sample(7, 5.25, "d", 1.5))
    out, _ = done_with(0, "convert", path, shown)
    assert out == f"{shown}\n", out
    info = parsed(done_with(0, "info", shown, "--json")[0])
    assert info["closed"] and [(c["topic"], c["messages"]) for c in info["channels"]] == [("/wrist", 2)], info
    before = shown.read_bytes()
    refused("convert", path, shown, naming=shown)
    wrong("convert", path, folder / "rec.npz",
          says=f"{folder}/rec.npz: expected a name that ends in .mcap, for an XDF file, found another extension")
    path.write_bytes(path.read_bytes()[:-5])
    out, _ = done_with(1, "convert", path, shown, "--force")
    assert f"warning  {path}: expected a last chunk of 25 bytes, found 20 bytes" in out, out
    assert parsed(done_with(0, "info", shown, "--json")[0])["messages"] == 1 and shown.read_bytes() != before


def read_by_core(path):
    """(topic, log time, the sample) of each message of a file that is whole."""
    read, = core("texts", path)
    assert read.get("done") is True, read
    return [(topic, int(log), parsed(text)) for topic, log, _, text in read["messages"]]


DOUBLES = [0.1, 1 / 3, -0.0, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 2.0**53 + 2, -1e-7]
WHOLE = [-(2**63), 2**63 - 1, 2**53 + 1, -(2**53) - 1, 0]
NO_NUMBERS = [(math.nan, "NaN"), (math.inf, "Infinity"), (-math.inf, "-Infinity")]


@case
def doubles_and_64_bit_integers_of_an_XDF_come_back_to_the_last_bit(folder):
    path, shown = folder / "rec.xdf", folder / "rec.mcap"
    path.write_bytes(BEGIN + stream(1, "double", "double64", len(DOUBLES), 0)
                     + stream(2, "whole", "int64", len(WHOLE), 0) + stream(3, "odd", "double64", 3, 0)
                     + chunk(4, struct.pack("<Idd", 1, 5.0, 0.25))
                     + sample(1, 5.1, "d", *DOUBLES) + sample(2, 6.0, "q", *WHOLE)
                     + sample(3, 7.0, "d", *(value for value, _ in NO_NUMBERS)))
    done_with(0, "convert", path, shown)
    read = {topic: (log, said) for topic, log, said in read_by_core(shown)}
    assert read.keys() == {"/double", "/whole", "/odd"}, read
    assert list(map(repr, read["/double"][1]["values"])) == list(map(repr, DOUBLES)), read  # -0.0 too
    assert read["/whole"][1]["values"] == WHOLE and all(isinstance(v, int) for v in read["/whole"][1]["values"]), read
    assert read["/odd"][1]["values"] == [word for _, word in NO_NUMBERS], read
    assert read["/double"][1]["stamp"] == 5.1 and read["/double"][0] == 5_350_000_000, read  # with its clock's offset
    assert read["/whole"] == (6_000_000_000, {"stamp": 6.0, "deduced": False, "values": WHOLE}), read


@case
def what_the_XDF_example_lists_is_what_convert_makes_of_it(folder):
    # The README of xdf-modules/example-files @ 76a6be7; the clock offsets in its chunks are -0.1 s.
    if not MINIMAL.exists():
        raise Skip("needs ../shared/data, which is not there")
    done_with(0, "convert", MINIMAL, folder / "minimal.mcap")
    read = read_by_core(folder / "minimal.mcap")
    numbers = [said for topic, _, said in read if topic == "/SendDataC"]
    assert [said["values"] for said in numbers] == [[192, 255, 238], *([[12, 22, 32], [13, 23, 33], [14, 24, 34],
                                                                        [15, 25, 35]] * 2)], numbers
    assert [log for topic, log, _ in read if topic == "/SendDataC"] == [
        round((5.0 + 0.1 * k) * 1e9) for k in range(9)], read
    texts = [said["values"][0] for topic, _, said in read if topic != "/SendDataC"]
    assert len(texts) == 9 and texts[0].startswith("<?xml") and texts[1:5] == ["Hello", "World", "from", "LSL"], texts


if __name__ == "__main__":
    sys.exit(main())
