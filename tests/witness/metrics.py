# SPDX-License-Identifier: Apache-2.0
"""Metrics of motion by NumPy and SciPy, from the formulas in the headers of kinalign/evaluate."""
from arrays import answer, given
import numpy as np
from scipy.spatial.transform import Rotation

J, RATE = 18, 30.0
y, p = given("truth", -1, J, 3), given("prediction", -1, J, 3)
ok = given("valid", -1, J) > 0
bones = given("bones", -1, 2).astype(int)
e = np.linalg.norm(p - y, axis=-1)
answer("distances", [e[ok].mean()])
fitted = []
for a, b, w in zip(p, y, ok):
    if w.sum() < 4:
        continue
    X, Y = a[w] - a[w].mean(0), b[w] - b[w].mean(0)
    R, _ = Rotation.align_vectors(Y, X)  # Kabsch by SciPy
    s = (Y * R.apply(X)).sum() / (X ** 2).sum()
    fitted.append(np.linalg.norm(s * R.apply(X) - Y, axis=-1))
answer("fitted", [np.concatenate(fitted).mean()])
w3 = ok[2:] & ok[1:-1] & ok[:-2]
w4 = w3[1:] & ok[:-3]
answer("smoothness", [np.linalg.norm(np.diff(p - y, 2, axis=0), axis=-1)[w3].mean(),
                      np.linalg.norm(np.diff(p, 3, axis=0), axis=-1)[w4].mean(),
                      np.linalg.norm(np.diff(y, 3, axis=0), axis=-1)[w4].mean()])
w2 = ok[1:] & ok[:-1]


def speeds(x):
    v = np.ma.array(np.linalg.norm(np.diff(x, axis=0), axis=-1), mask=~w2)
    return v - v.mean(0)


def correlation(k):
    a, b = speeds(y), speeds(p)
    a, b = (a[:len(a) - k], b[k:]) if k >= 0 else (a[-k:], b[:k])
    both = ~(a.mask | b.mask)
    a, b = a.data[both], b.data[both]
    return (a * b).sum() / np.sqrt((a * a).sum() * (b * b).sum())


c = np.array([correlation(k) for k in range(-15, 16)])
k = int(c.argmax())
if 0 < k < 30:  # at the end of the range there is no lag
    top = np.polynomial.Polynomial.fit([-1, 0, 1], c[k - 1:k + 2], 2).deriv().roots()[0]
answer("lag", [(k - 15 + top) / RATE] if 0 < k < 30 else [])
rooted = ok & ok[:, :1]
far = lambda x: np.ma.array(np.linalg.norm(x - x[:, :1], axis=-1), mask=~rooted).std(0).sum()
answer("amplitude", [far(p) / far(y)])

skates, true_skates = [], []
for foot in (13, 17):
    w, h = ok[:, foot], y[:, foot, 1]
    floor = np.percentile(h[w], 1)
    v = np.linalg.norm(np.diff(y[:, foot], axis=0), axis=-1) * RATE
    low = np.concatenate([[False], w2[:, foot] & (v < 1.5) & (h[1:] < floor + 0.2)])
    edges = np.flatnonzero(np.diff(np.concatenate([[0], low.astype(int), [0]])))
    for a, b in zip(edges[::2], edges[1::2]):
        if b - a < 3:
            low[a:b] = False
    flat = lambda x: np.linalg.norm(np.diff(x[:, foot][:, [0, 2]], axis=0), axis=-1)[low[1:]] * RATE
    skates.append(flat(p))
    true_skates.append(flat(y))
skates = np.concatenate(skates)
answer("feet", [len(skates), skates.mean(), np.concatenate(true_skates).mean()])

radius = 2.5 * given("sigmas", -1, J)[ok]
error = np.linalg.norm((p - y)[ok], axis=-1)
held = (error <= radius).mean()
answer("radii", [held, radius.mean()])
answer("one_radius", [np.quantile(error, held)])


def nine(truth, out):
    """BRA_DGN's three sums, with the matrix O written out."""
    T = len(out)
    O = np.diag(-2.0 * np.ones(T + 2)) + np.diag(np.ones(T + 1), 1) + np.diag(np.ones(T + 1), -1)
    O[0, 0] = O[-1, -1] = -1
    rough = lambda x: np.linalg.norm(np.pad(x.reshape(T, -1).T, ((0, 0), (1, 1)), mode="edge") @ O) / (T + 2)
    length = lambda x: np.linalg.norm(x[:, bones[:, 0]] - x[:, bones[:, 1]], axis=-1)
    return [((out - truth) ** 2).mean(), np.abs(length(out) - length(truth)).mean(), rough(out), rough(truth)]


def own_root(x):
    left = x[:, 10] - x[:, 14] + x[:, 4] - x[:, 7]
    angle = np.arctan2(left[:, 2], left[:, 0])
    moved = x - x[:, :1] * [1, 0, 1]
    return np.stack([Rotation.from_euler("y", one).apply(body) for one, body in zip(angle, moved)])


answer("nine", nine(100 * y, 100 * p) + nine(100 * own_root(y), 100 * own_root(p)))
