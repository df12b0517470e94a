#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The peer of `kinalign align`: the script a lab writes today. One take: BVH + Kinect CSV + IMU CSV
-> numpy/scipy -> h5py. Prints the seconds and peak memory of every step and the scaling to HFUT-MMD.
usage: job.py FILE.bvh DIR [way: loadtxt|split]"""
import resource, sys, time
import numpy as np, h5py
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation as R, Slerp
src, d, way = sys.argv[1], sys.argv[2], (sys.argv[3] if len(sys.argv) > 3 else "split")
head = open(src).read(200000); frames = int(head[head.index("Frames:") + 7:].split()[0])
dur = frames / 60; rng = np.random.default_rng(1)
def csv(path, n, c, hz):                       # made before the clock starts
    t = np.sort(np.arange(n) / hz + .004 * rng.standard_normal(n).clip(-3, 3)); np.savetxt(path, np.column_stack([t, rng.standard_normal((n, c))]), fmt="%.6f", delimiter=",")
csv(d + "/k.csv", int(dur * 30), 75, 30)
for i in range(5): csv(f"{d}/w{i}.csv", int(dur * 15), 7, 15)
t = [("start", time.perf_counter())]
def mark(n): t.append((n, time.perf_counter()))
text = open(src).read(); body = text[text.index("\n", text.index("Frame Time:")) + 1:]
ch = (np.loadtxt(body.splitlines()) if way == "loadtxt" else np.array(body.split(), float)).reshape(frames, -1, 6); mark("read BVH")
par, stack = [], []
for line in text[:text.index("MOTION")].splitlines():
    w = line.split()
    if w[0] in ("ROOT", "JOINT"): par.append(stack[-1] if stack else -1); name = len(par) - 1
    elif w[0] == "End": name = stack[-1]
    elif w[0] == "{": stack.append(name)
    elif w[0] == "}": stack.pop()
m = R.from_euler("YXZ", ch[..., 3:].reshape(-1, 3), degrees=True); quat = m.as_quat().reshape(frames, -1, 4); m = m.as_matrix().reshape(frames, -1, 3, 3)
wr, wp = np.empty_like(m), np.empty((frames, len(par), 3)); wr[:, 0], wp[:, 0] = m[:, 0], ch[:, 0, :3]
for j in range(1, len(par)): wr[:, j] = wr[:, par[j]] @ m[:, j]; wp[:, j] = wp[:, par[j]] + (wr[:, par[j]] @ ch[:, j, :3, None])[..., 0]
mark("forward kinematics")
k = np.loadtxt(d + "/k.csv", delimiter=","); w = [np.loadtxt(f"{d}/w{i}.csv", delimiter=",") for i in range(5)]; mark("read Kinect and IMU CSV")
g = np.arange(frames) / 60
g = g[(g >= k[0, 0]) & (g <= k[-1, 0]) & (g >= max(x[0, 0] for x in w)) & (g <= min(x[-1, 0] for x in w))]
ks = CubicSpline(k[:, 0], k[:, 1:], bc_type="natural")(g); acc = [CubicSpline(x[:, 0], x[:, 1:4], bc_type="natural")(g) for x in w]; mark("splines")
ori = [Slerp(x[:, 0], R.from_quat(x[:, 4:8] + 1e-3))(g).as_quat() for x in w]; mark("slerp")
a = np.radians(60); A = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
kk = ks.reshape(-1, 25, 3) @ A.T; i = np.searchsorted(np.arange(frames) / 60, g); kk += wp[i, :1] / 100 - kk[:, :1]; mark("space")
with h5py.File(d + "/take.h5", "w") as f:
    f["time_ns"] = (g * 1e9).astype("i8"); f["mocap/positions"] = (wp[i] / 100).astype("f4"); f["mocap/rotations"] = quat[i].astype("f4"); f["kinect/positions"] = kk.astype("f4")
    f["imu/orientation"] = np.stack(ori, 1).astype("f4"); f["imu/acceleration"] = np.stack(acc, 1).astype("f4")
mark("write HDF5")
scale = 2.96e6 / frames; total = t[-1][1] - t[0][1]
for (_, a), (n, b) in zip(t, t[1:]): print(f"{n:24s} {b-a:8.3f} s {100*(b-a)/total:5.1f} %")
print(f"total {total:.2f} s for {frames} frames = {frames/total:.0f} frames/s; HFUT-MMD size (2.96 M frames): {total*scale:.0f} s; peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss/1e6:.2f} GB")
print(f'{{"seconds": {total:.3f}}}')
