# SPDX-License-Identifier: Apache-2.0
"""Joint positions of BVH files by a plain forward kinematics in NumPy, for tests/formats/bvh/files_test.cpp.
FOLDER/files.txt names one file a line; FOLDER/positions.csv gets file, frame, joint_index, joint, x, y, z of
all joints at the first, the middle and the last frame, in the file's own unit."""
import pathlib
import sys

import numpy as np


def parsed(text):
    """Joints as [name, parent, offset, channels], and the rows."""
    head, _, motion = text.partition("MOTION")
    joints, open_ = [], []  # open_: joints, or None for an end site
    for line in head.replace("{", "\n{\n").replace("}", "\n}\n").splitlines():
        word, _, rest = line.strip().replace("\t", " ").partition(" ")
        if word in ("ROOT", "JOINT"):
            joints.append([rest.strip(), open_[-1] if open_ else -1, np.zeros(3), []])
            upcoming = len(joints) - 1
        elif word == "End":
            upcoming = None
        elif word == "{":
            open_.append(upcoming)
        elif word == "}":
            open_.pop()
        elif word == "OFFSET" and open_[-1] is not None:
            joints[open_[-1]][2] = np.array(rest.split(), float)
        elif word == "CHANNELS" and open_[-1] is not None:
            joints[open_[-1]][3] = rest.split()[1:]
    values = motion.split()
    first = next(i for i, word in enumerate(values) if word.startswith("Time")) + 2
    width = sum(len(joint[3]) for joint in joints)
    numbers = np.array(values[first:], float)
    return joints, numbers[: len(numbers) // width * width].reshape(-1, width)


def about(axis, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turn = np.eye(3)
    turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
    return turn


def places(joints, row):
    out, turns, column = [], [], 0
    for _, parent, offset, channels in joints:
        at, turn = offset.copy(), np.eye(3)
        for channel in channels:
            axis = "XYZ".index(channel[0])
            if channel[1:] == "position":
                at[axis] = row[column]
            else:
                turn = turn @ about(axis, row[column])
            column += 1
        if parent >= 0:
            at, turn = out[parent] + turns[parent] @ at, turns[parent] @ turn
        out.append(at)
        turns.append(turn)
    return out


folder = pathlib.Path(sys.argv[1])
with open(folder / "positions.csv", "w") as csv:
    csv.write("file,frame,joint_index,joint,x,y,z\n")
    for name in (folder / "files.txt").read_text().splitlines():
        joints, rows = parsed(pathlib.Path(name).read_text())
        for frame in sorted({0, len(rows) // 2, len(rows) - 1}):
            for j, at in enumerate(places(joints, rows[frame])):
                csv.write(f"{name},{frame},{j},{joints[j][0]},{at[0]:.9f},{at[1]:.9f},{at[2]:.9f}\n")
