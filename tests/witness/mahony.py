# SPDX-License-Identifier: Apache-2.0
"""The explicit complementary filter with rotation matrices and Rodrigues' formula, as the paper writes it."""
import numpy as np
from arrays import answer, given

dt, rates, accelerations = given("dt"), given("rates", -1, 3), given("accelerations", -1, 3)
kp, ki = given("gains")


def cross(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def turn(r):
    angle = np.linalg.norm(r)
    if angle < 1e-12:
        return np.eye(3) + cross(r)
    k = cross(r / angle)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


# The first sample: the shortest way from the measured up to +y, then the heading.
up = np.array([0.0, 1.0, 0.0])
v = accelerations[0] / np.linalg.norm(accelerations[0])
axis = np.cross(v, up)
R = turn(given("heading")[0] * up) @ turn(axis / np.linalg.norm(axis) * np.arccos(v @ up))
b = given("bias").copy()
rotations, biases = [R], [b.copy()]
for h, rate, a in zip(dt[1:], rates[1:], accelerations[1:]):
    measured = np.cross(a / np.linalg.norm(a), R.T @ up)
    R = R @ turn(h * (rate - b + kp * measured))
    b = b - ki * h * measured
    rotations.append(R)
    biases.append(b.copy())
answer("rotations", rotations)
answer("biases", biases)
