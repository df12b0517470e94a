# SPDX-License-Identifier: Apache-2.0
"""Whole takes against SciPy, from the raw files: nothing here is taken from our own code.
numbers_check.py BUILD_FOLDER [CASE...]"""
import csv
import json
import pathlib
import sys
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import h5py
import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation, RotationSpline, Slerp

from cases import case, demo, kinalign, law, main


def table(path):
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    stamps = np.array([int(r[0]) for r in rows[1:]])
    cells = np.array([[float(c) if c.strip() else np.nan for c in r[1:]] for r in rows[1:]])
    keep, last = [], -2**63
    for i, t in enumerate(stamps):
        if t > last:
            keep.append(i)
            last = int(t)
    return stamps[keep], cells[keep]


def segments(stamps, gap_ns):
    cuts = np.flatnonzero(np.diff(stamps) > gap_ns) + 1
    return np.split(np.arange(len(stamps)), cuts) if len(stamps) else []


def over(stamps, grid, gap_ns, curve, width):
    """Values [T, width] of curve(x, indices)(at) between gaps, and where there are any."""
    out, valid = np.zeros((len(grid), width)), np.zeros(len(grid), bool)
    for knots in segments(stamps, gap_ns):
        rows = (grid >= stamps[knots[0]]) & (grid <= stamps[knots[-1]])
        if not rows.any():
            continue
        x = (stamps[knots] - stamps[knots[0]]) * 1e-9
        out[rows] = curve(x, knots)((grid[rows] - stamps[knots[0]]) * 1e-9)
        valid |= rows
    return out, valid


def spline_of(values):
    def curve(x, knots):
        if len(knots) == 1:
            return lambda at: np.repeat(values[knots], len(at), 0)
        return CubicSpline(x, values[knots], bc_type="natural")
    return curve


def wxyz(q):
    return np.concatenate([q[..., 3:], q[..., :3]], -1)


def turns_of(rotations, method):
    def curve(x, knots):
        if len(knots) == 1:
            return lambda at: np.repeat(rotations[knots].as_quat(), len(at), 0)
        make = RotationSpline if method == "spline" else Slerp
        return lambda at: make(x, rotations[knots])(np.clip(at, x[0], x[-1])).as_quat()
    return curve


def angle(a, b):
    """Between quaternions w,x,y,z, rad; exact where it is small."""
    dot = np.abs(np.sum(a * b, -1))
    apart = np.minimum(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    return np.where(dot > 0.9, 4 * np.arcsin(np.clip(apart / 2, 0, 1)) / 1, 2 * np.arccos(np.clip(dot, 0, 1)))


def taken(folder, seconds, *flags, seed=1):
    recording = demo(folder / "d", seconds=seconds, seed=seed)
    words = ("align", recording / "recording.toml", "-o", folder / "t.h5", "--force", *flags)
    done = kinalign(*words)
    said = law(done, words)
    assert done.returncode == 0, said
    return h5py.File(folder / "t.h5")


def streams(take):
    report = json.loads(take["report_json"][()].decode().rstrip("\0"))
    return report, {(s["stream"], ", ".join(s.get("nodes", []))): s for s in report["streams"]}


def check_kinect(folder, take, tolerance):
    grid = take["time_ns"][:]
    report, of = streams(take)
    stamps, cells = table(folder / "d/kinect.csv")
    cells = cells.reshape(len(stamps), 25, 4)
    space = report["spaces"][0]
    q, move = np.array(space["rotation"]), np.array(space["translation_m"])
    turn = Rotation.from_quat(q[[1, 2, 3, 0]]).as_matrix()
    ours, valid = take["kinect/positions"][:], take["kinect/valid"][:] == 1
    worst = 0.0
    for j in range(25):
        seen = cells[:, j, 3] > 0
        at, there = over(stamps[seen], grid, of["kinect", ""]["gap_ns"],
                         spline_of(cells[seen, j, :3]), 3)
        assert (there == valid[:, j]).all(), f"joint {j}: valid rows differ"
        at[there] = at[there] @ turn.T + move
        assert (ours[~there, j] == 0).all(), "what is not valid is not zero"
        worst = max(worst, np.abs(ours[:, j] - at).max())
    assert worst <= tolerance, f"positions differ by {worst} m"
    assert of["kinect", ""]["invalid"] == np.count_nonzero(~valid), "the report's count differs"
    left = np.clip(np.searchsorted(stamps, grid, "right") - 1, 0, len(stamps) - 1)
    right = np.where(stamps[left] == grid, left, np.minimum(left + 1, len(stamps) - 1))
    state = np.where(valid, np.minimum(cells[left, :, 3], cells[right, :, 3]), 0)
    assert (take["kinect/state"][:] == state).all(), "states differ"
    nearest = np.minimum(np.abs(grid - stamps[left]), np.abs(stamps[right] - grid))
    assert (take["kinect/nearest_raw_ns"][:] == nearest).all()


def check_imu(folder, take, method, tolerance, angle_tolerance):
    grid = take["time_ns"][:]
    report, of = streams(take)
    names = list(take["imu/node_names"].asstr())
    manifest = tomllib.loads((folder / "d/recording.toml").read_text())["stream"]["imu"]
    nodes = {}
    for node in names:
        stamps, c = table(folder / "d" / manifest["files"][node])
        stamps = stamps + round(manifest.get("offset_ms", 0) * 1e6)
        good = ~np.isnan(c).any(1)
        stamps, c = stamps[good], c[good]
        turns = Rotation.from_quat(c[:, [1, 2, 3, 0]])
        vectors = np.hstack([turns.apply(c[:, 4:7]), turns.apply(c[:, 7:10])])
        gap = of["imu", node]["gap_ns"]
        v, there = over(stamps, grid, gap, spline_of(vectors), 6)
        q, _ = over(stamps, grid, gap, turns_of(turns, method), 4)
        q[~there] = (0, 0, 0, 1)
        nodes[node] = (Rotation.from_quat(q), v[:, :3], v[:, 3:], there)
    root, root_a, _, root_there = nodes[manifest["root_node"]]
    for s, node in enumerate(names):
        q, a, w, there = nodes[node]
        there = there & root_there
        is_root = node == manifest["root_node"]
        valid = take["imu/valid"][:, s] == 1
        assert (valid == there).all(), f"{node}: valid rows differ"
        q = q if is_root else root.inv() * q
        a = root.inv().apply(a if is_root else a - root_a)
        apart = angle(take["imu/orientation"][:, s], wxyz(q.as_quat()))[there]
        assert apart.max() <= angle_tolerance, f"{node}: orientations differ by {apart.max()} rad"
        for name, value in (("acceleration", a), ("angular_velocity", root.inv().apply(w))):
            apart = np.abs(take[f"imu/{name}"][:, s] - value)[there].max()
            assert apart <= tolerance, f"{node}: {name} differs by {apart}"
            assert (take[f"imu/{name}"][:, s][~there] == 0).all()
        assert of["imu", node]["invalid"] == np.count_nonzero(~valid), f"{node}: the report's count differs"
        stands = np.linalg.norm(take["imu/acceleration"][:, s][valid].mean(0)) > 5
        assert (take["imu"].attrs["gravity"][s] == b"included") == stands, f"{node}: gravity is said falsely"


def check_mocap(folder, take, tolerance):
    text = (folder / "d/mocap.bvh").read_text()
    body = text[text.index("Frame Time:"):].split("\n", 1)
    rows = np.array(body[1].split(), float).reshape(-1, 6 * 59)
    step = float(body[0].split()[-1])
    start = tomllib.loads((folder / "d/recording.toml").read_text())["stream"]["mocap"]["start_ns"]
    grid = take["time_ns"][:]
    k = np.rint((grid - start) * 1e-9 / step).astype(int)
    assert (np.abs(grid - start - k * step * 1e9) <= 1).all() and (np.diff(k) == 1).all()
    order = [l.split()[2:] for l in text.splitlines() if l.split()[:1] == ["CHANNELS"]]
    for j in (0, 7, 30, 58):
        own = rows[k, 6 * j:6 * j + 6]
        axes = "".join(c[0] for c in order[j] if c.endswith("rotation"))
        q = wxyz(Rotation.from_euler(axes, own[:, 3:], degrees=True).as_quat())
        apart = angle(take["mocap/local_rotations"][:, j], q).max()
        assert apart <= tolerance, f"joint {j}: rotations differ by {apart} rad"
        apart = np.abs(take["mocap/local_positions"][:, j] - 0.01 * own[:, :3]).max()
        assert apart <= tolerance, f"joint {j}: positions differ by {apart} m"


@case
def a_take_of_the_demo_is_what_SciPy_makes_of_its_raw_files(folder):
    for seed, flags, method, tolerance, turn in ((1, (), "spline", 1e-6, 1e-6),
                                                 (2, ("--double",), "spline", 4e-11, 1e-7),
                                                 (3, ("--double", "--rotations", "slerp"), "slerp", 4e-11, 1e-11)):
        with taken(folder, 90 if seed == 2 else 6, *flags, seed=seed) as take:
            check_mocap(folder, take, min(tolerance, turn))
            check_kinect(folder, take, max(tolerance, 2e-7 if not flags else 0) if flags else 2e-6)
            check_imu(folder, take, method, 4e-6 if not flags else 3e-6 if method == "spline" else tolerance, turn)


if __name__ == "__main__":
    sys.exit(main())
