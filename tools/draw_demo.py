# SPDX-License-Identifier: Apache-2.0
"""The picture of README.md from the demo: draw_demo.py KINALIGN DEMO_FOLDER OUT.svg

The right wrist's height over five seconds: the Kinect's raw samples, brought into the mocap's space
by the take's transform, the take's resampled curve, the mocap. The same demo gives the same bytes.
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

BEGIN, LENGTH = 22.5, 5.0  # s of the take
LEFT, RIGHT, TOP, BOTTOM = 70, 780, 22, 300  # px
LOW, HIGH = 0.6, 2.0  # m
MOCAP, KINECT, INK = "#c0392b", "#1e8449", "#333333"


def x_of(t):
    return LEFT + (t - BEGIN) / LENGTH * (RIGHT - LEFT)


def y_of(height):
    return BOTTOM - (height - LOW) / (HIGH - LOW) * (BOTTOM - TOP)


def take_of(kinalign, folder):
    """The take's arrays, and the transform that its report states."""
    with tempfile.TemporaryDirectory() as scratch:
        npz = pathlib.Path(scratch) / "take.npz"
        subprocess.run([kinalign, "convert", folder / "take.h5", npz, "-q"], check=True)
        with np.load(npz) as arrays:
            take = {name: arrays[name] for name in arrays.files}
    facts = subprocess.run([kinalign, "info", folder / "take.h5", "--json"], check=True,
                           capture_output=True, text=True).stdout
    return take, json.loads(facts)["report"]["spaces"][0]


def rotated(q, v):
    w, u = q[0], np.array(q[1:])
    return v + 2 * np.cross(u, np.cross(u, v) + w * v)


def raw_wrist(folder, space, start_ns):
    """Seconds and heights of the Kinect's own samples."""
    with open(folder / "kinect.csv", newline="", encoding="utf-8") as text:
        rows = [r for r in csv.DictReader(text) if r["WristRight_state"] != "0"]
    points = np.array([[float(r[f"WristRight_{a}"]) for a in "xyz"] for r in rows])
    seconds = np.array([(int(r["time_ns"]) - start_ns) * 1e-9 for r in rows])
    return seconds, rotated(space["rotation"], points)[:, 1] + space["translation_m"][1]


def line(seconds, heights, colour, width):
    points = " ".join(f"{x_of(t):.1f},{y_of(h):.1f}" for t, h in zip(seconds, heights))
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}"/>'


def runs(mask):
    """[first, last] of stretches where `mask` is true."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(int), [0]))))
    return zip(edges[::2], edges[1::2] - 1)


def text(x, y, words, anchor="middle", colour=INK):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{words}</text>'


def axes():
    parts = []
    for k in range(6):
        x = x_of(BEGIN + k)
        parts += [f'<path d="M{x:.1f} {TOP}V{BOTTOM}" class="grid" stroke="#dddddd"/>', text(x, BOTTOM + 18, f"{BEGIN + k:.1f}")]
    for height in (0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0):
        y = y_of(height)
        parts += [f'<path d="M{LEFT} {y:.1f}H{RIGHT}" class="grid" stroke="#dddddd"/>', text(LEFT - 8, y + 4, f"{height:.1f}", "end")]
    middle = (TOP + BOTTOM) / 2
    parts.append(text((LEFT + RIGHT) / 2, BOTTOM + 38, "time from the first frame, s"))
    parts.append(f'<g transform="rotate(-90 22 {middle})">' + text(22, middle, "height of the right wrist, m") + "</g>")
    return parts


def legend():
    y = BOTTOM + 62
    return [f'<path d="M70 {y - 4}h24" stroke="{MOCAP}" stroke-width="2"/>', text(100, y, "mocap, 60 Hz", "start"),
            f'<circle cx="228" cy="{y - 4}" r="3" fill="none" stroke="{KINECT}"/>', text(238, y, "Kinect, raw, 30 Hz", "start"),
            f'<path d="M390 {y - 4}h24" stroke="{KINECT}" stroke-width="1.5"/>', text(420, y, "Kinect on the mocap's grid", "start"),
            f'<rect x="620" y="{y - 11}" width="24" height="13" fill="url(#gap)" stroke="#999999"/>', text(650, y, "gap: marked invalid", "start")]


def picture(take, space, folder):
    seconds = (take["time_ns"] - take["time_ns"][0]) * 1e-9
    here = (seconds >= BEGIN) & (seconds <= BEGIN + LENGTH)
    hand = list(take["mocap_joint_names"]).index("RightHand")
    wrist = list(take["kinect_joint_names"]).index("WristRight")
    valid = take["kinect_valid"][here, wrist] == 1
    t, mocap, kinect = seconds[here], take["mocap_positions"][here, hand, 1], take["kinect_positions"][here, wrist, 1]
    parts = axes()
    for first, last in runs(~valid):
        parts.append(f'<rect x="{x_of(t[first]):.1f}" y="{TOP}" width="{x_of(t[last]) - x_of(t[first]):.1f}" '
                     f'height="{BOTTOM - TOP}" fill="url(#gap)"/>')
    for first, last in runs(valid):
        parts.append(line(t[first:last + 1], kinect[first:last + 1], KINECT, 1.5))
    parts.append(line(t, mocap, MOCAP, 2))
    for at, height in zip(*raw_wrist(folder, space, int(take["time_ns"][0]))):
        if BEGIN <= at <= BEGIN + LENGTH:
            parts.append(f'<circle cx="{x_of(at):.1f}" cy="{y_of(height):.1f}" r="3" fill="none" stroke="{KINECT}"/>')
    return parts + legend()


def main():
    kinalign, folder, out = (pathlib.Path(a) for a in sys.argv[1:4])
    parts = picture(*take_of(kinalign.resolve(), folder), folder)
    out.write_text("\n".join([
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 810 375" font-family="sans-serif" font-size="13">',
        "<title>A Kinect's wrist brought onto the mocap's grid and into its space</title>",
        '<defs><pattern id="gap" width="6" height="6" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
        '<path d="M0 0V6" stroke="#999999" stroke-width="1.5"/></pattern></defs>',
        "<style>@media (prefers-color-scheme: dark) { .paper { fill: #15181c } text { fill: #e4e6e8 } "
        ".grid { stroke: #343a40 } }</style>",
        '<rect class="paper" width="810" height="375" fill="#ffffff"/>', *parts, "</svg>", ""]), encoding="utf-8")


main()
