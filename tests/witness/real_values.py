# SPDX-License-Identifier: Apache-2.0
"""Every number of real recordings by a plain reading in Python, for tests/sources/real_values_test.cpp.
FOLDER/files.txt names one a line: how it is to be read, a tab, its path. Of line i come i_stamps (seconds and
nanoseconds), i_positions, i_orientation, i_acceleration, i_angular_velocity: metres, y up, nan where nothing is."""
import csv
import decimal
import pathlib
import re
import sys

import numpy as np

folder = pathlib.Path(sys.argv[1])
Y_UP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]], float)  # of z up: a quarter turn about x
SECOND = 10**9


def number(cell):
    cell = cell.strip()
    return float(cell) if cell and cell.lower() != "nan" else np.nan


def ns(text, scale=SECOND):
    return int((decimal.Decimal(text) * scale).to_integral_value(decimal.ROUND_HALF_EVEN))


def by_rate(rows, hertz):
    return [round(k * SECOND / hertz) for k in range(rows)]


def turned(quaternions):
    """World with y up from world with z up, w first; [..., 4]."""
    half = np.sqrt(0.5)
    w, x, y, z = np.moveaxis(quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True), -1, 0)
    return half * np.stack([w + x, x - w, y + z, z - y], -1)  # (half, -half, 0, 0) times it


def rows_of(text, delimiter):
    return [line.split(delimiter) for line in text.splitlines() if line.strip() and not line.startswith("//")]


def columns(head, names):
    head = [name.strip() for name in head]
    return [head.index(name) for name in names]


def points_by_name(rows, joints, ends):
    at = columns(rows[0], [joint + end for joint in joints for end in ends])
    return np.array([[number(row[i]) for i in at] for row in rows[1:]]).reshape(len(rows) - 1, -1, 3)


def joints_with(end, head):
    return [name.strip()[: -len(end)] for name in head if name.strip().endswith(end)]


def keraal(text, scale, axes, hertz):
    all_ = np.array([[float(x) for x in line.split()] for line in text.splitlines()])
    return {"positions": scale * all_.reshape(len(all_), -1, 7)[:, :, :3] @ axes.T,
            "stamps": by_rate(len(all_), hertz)}


def unsw_vicon(text):
    rows = rows_of(text, ",")
    joints = [j for j in joints_with("_1", rows[0]) if not j.startswith("q")]
    return {"positions": points_by_name(rows, joints, ("_1", "_2", "_3")) @ Y_UP.T,
            "stamps": by_rate(len(rows) - 1, 100)}


def unsw_imu(text):
    rows = rows_of(text, ",")
    all_ = np.array(rows[1:], float)
    return {"orientation": turned(all_[:, :4]), "acceleration": all_[:, 4:7],
            "angular_velocity": all_[:, 7:10], "stamps": by_rate(len(all_), 100)}


def laban(text):
    rows = rows_of(text, ",")
    all_ = np.array([[float(c) for c in row if c.strip()] for row in rows])
    joints = all_[:, 1:101].reshape(len(all_), 25, 4)
    joints[joints[:, :, 3] == 0] = np.nan  # not tracked
    return {"positions": joints[:, :, :3], "stamps": [100 * int(row[0]) for row in rows]}


def phone(text):
    rows = list(csv.reader(text.splitlines()))
    return {"positions": points_by_name(rows, joints_with("_state", rows[0]), ("_x", "_y", "_z")),
            "stamps": [ns(row[1], 10**6) for row in rows[1:]]}


def ui_prmd(text):
    all_ = np.array([[float(x) for x in line.split(",")] for line in text.splitlines()])
    points = all_.reshape(len(all_), -1, 3)
    points[(points == 0).all(-1)] = np.nan
    return {"positions": 0.001 * points @ Y_UP.T, "stamps": by_rate(len(all_), 100)}


def trc(text):
    lines = [line.split("\t") for line in text.splitlines()]
    width, unit = int(lines[2][3]), {"mm": 0.001, "m": 1.0}[lines[2][4].strip()]
    rows = [(row + [""] * 3 * width)[: 2 + 3 * width] for row in lines[5:] if "".join(row).strip()]
    points = np.array([[number(c) for c in row[2:]] for row in rows]).reshape(len(rows), width, 3)
    points[np.isnan(points).any(-1)] = np.nan
    return {"positions": unit * points, "stamps": [ns(row[1]) for row in rows]}


def sto(text):
    rows = [line.split("\t") for line in text.split("endheader", 1)[1].splitlines() if line.strip()]
    quaternions = [[[float(x) for x in cell.split(",")] for cell in row[1:] if cell] for row in rows[1:]]
    return {"orientation": turned(np.array(quaternions)), "stamps": [ns(row[0]) for row in rows[1:]]}


def xsens(text):
    rate = float(re.search(r"Update Rate: ([0-9.]+)Hz", text).group(1))
    first = next(line for line in text.splitlines() if line.startswith("PacketCounter"))
    rows = rows_of(text, next(c for c in "\t,; " if c in first))
    head, rows = rows[0], rows[1:]

    def found(*names):
        at = columns(head, names)
        return np.array([[number(row[i]) for i in at] for row in rows])

    counter = np.unwrap([int(row[0]) for row in rows], period=65536)
    out = {"acceleration": found("Acc_X", "Acc_Y", "Acc_Z"),
           "stamps": [round(int(n) * SECOND / rate) for n in counter]}
    if "Gyr_X" in head:
        out["angular_velocity"] = found("Gyr_X", "Gyr_Y", "Gyr_Z")
    if "Quat_q0" in head:
        out["orientation"] = turned(found("Quat_q0", "Quat_q1", "Quat_q2", "Quat_q3"))
    return out


READ = {"keraal_kinect": lambda text: keraal(text, 1.0, np.eye(3), 30),
        "keraal_vicon": lambda text: keraal(text, 0.001, Y_UP, 60),
        "kinect_laban": laban, "kinect2_phone_skip": phone, "ui_prmd_vicon": ui_prmd,
        "unsw_vicon": unsw_vicon, "unsw_imu": unsw_imu, "trc": trc, "sto": sto, "xsens": xsens}

for i, line in enumerate((folder / "files.txt").read_text().splitlines()):
    way, path = line.split("\t")
    for name, values in READ[way](pathlib.Path(path).read_text(encoding="latin-1")).items():
        if name == "stamps":
            values = [part for stamp in values for part in divmod(stamp, SECOND)]
        np.asarray(values, "<f8").tofile(folder / f"{i}_{name}.out")
