# SPDX-License-Identifier: Apache-2.0
"""Writes windows_numpy.npz beside itself: a small file of windows, as numpy.savez has it (NumPy 1.24.2)."""
import json
import pathlib

import numpy

TIME_NS = [round(row * 1e9 / 30) for row in (0, 2, 10, 0)]
FIRST, ROWS, TAKE, PART = [0, 2, 10, 0], [4, 4, 3, 4], [0, 0, 0, 1], [0, 0, 0, 1]
LENGTH = 4


def rows(channels, begin):
    """Row r of a take holds begin + r + c / 16 in channel c; rows behind the end repeat the last one."""
    out = numpy.zeros((len(FIRST), LENGTH, channels), "<f4")
    for w, first in enumerate(FIRST):
        for t in range(LENGTH):
            out[w, t] = begin + first + min(t, ROWS[w] - 1) + numpy.arange(channels) / 16
    return out


real = numpy.arange(LENGTH)[None, :] < numpy.array(ROWS)[:, None]
valid = numpy.repeat(real[:, :, None], 3, 2).astype("|u1")
valid[0, 1, 2] = 0
state = numpy.full((len(FIRST), LENGTH, 3), 2, "|u1")
state[0, 1, 2], state[0, 3, 1], state[1, 1, 1] = 0, 1, 1
kinect = ["SpineBase", "HipLeft", "HipRight"]
mocap = ["Hips", "LeftUpLeg", "RightUpLeg"]
manifest = {"schema": "kinalign.windows/1", "dataset": "wal𝄞ks é", "licence": "CC0-1.0", "citation": "nobody, 2026",
            "rate_hz": 30.0, "parts": ["train", "validation"],
            "takes": [{"name": "S01-A1", "subject": "S01", "action": "A1"},
                      {"name": "S02-A1", "subject": "S02", "action": "A1"}],
            "streams": [{"name": "mocap", "kind": "skeleton", "names": mocap, "parents": [-1, 0, 0]},
                        {"name": "kinect", "kind": "points", "names": kinect}]}
numpy.savez(pathlib.Path(__file__).with_name("windows_numpy.npz"), take=numpy.array(TAKE, "<i4"),
            part=numpy.array(PART, "|u1"), first=numpy.array(FIRST, "<i8"), rows=numpy.array(ROWS, "<i4"), time_ns=numpy.array(TIME_NS, "<i8"),
            mocap_positions=rows(9, 100), mocap_valid=real[:, :, None].astype("|u1"),
            mocap_rest_offsets=numpy.arange(18, dtype="<f4").reshape(2, 3, 3),
            kinect_positions=rows(9, 0), kinect_valid=valid, kinect_state=state,
            manifest=numpy.array(json.dumps(manifest, ensure_ascii=False)))
