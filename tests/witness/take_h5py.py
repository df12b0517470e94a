# SPDX-License-Identifier: Apache-2.0
"""Opens a take of tests/formats/take/hdf5_test.cpp (50 frames) as a user would, and looks at all of it."""
import json
import sys

import h5py
import numpy as np

shapes = {
    "time_ns": ((50,), "<i8"), "seconds": ((50,), "<f8"), "t0_ns": ((), "<i8"),
    "mocap/positions": ((50, 3, 3), "<f4"), "mocap/local_positions": ((50, 3, 3), "<f4"),
    "mocap/local_rotations": ((50, 3, 4), "<f4"), "mocap/parents": ((3,), "<i4"),
    "mocap/rest_offsets": ((3, 3), "<f8"), "mocap/joint_names": ((3,), "|S6"),
    "mocap/end_sites/parents": ((1,), "<i4"), "mocap/end_sites/offsets": ((1, 3), "<f8"),
    "kinect/positions": ((50, 2, 3), "<f4"), "kinect/state": ((50, 2), "|u1"),
    "kinect/valid": ((50, 2), "|u1"), "kinect/joint_names": ((2,), "|S9"),
    "kinect/nearest_raw_ns": ((50,), "<i8"), "kinect/time_interval_ns": ((50,), "<i8"),
    "imu/orientation": ((50, 2, 4), "<f4"), "imu/acceleration": ((50, 2, 3), "<f4"),
    "imu/valid": ((50, 2), "|u1"), "imu/node_names": ((2,), "|S10"),
    "imu/nearest_raw_ns": ((50, 2), "<i8"),
}
with h5py.File(sys.argv[1], "r") as take:
    found = {}
    take.visititems(lambda name, thing: found.__setitem__(name, thing) if isinstance(thing, h5py.Dataset) else None)
    assert set(found) == set(shapes) | {"report_json", "parameters_json"}, sorted(found)
    for name, (shape, dtype) in shapes.items():
        assert found[name].shape == shape, (name, found[name].shape)
        assert found[name].dtype == np.dtype(dtype), (name, found[name].dtype)
        assert found[name].chunks is None and found[name].compression is None, name
    assert (np.diff(take["time_ns"]) == 16_666_667).all()
    assert take["t0_ns"][()] == take["time_ns"][0] == 1_700_000_000_000_000_000
    assert np.allclose(take["seconds"], np.arange(50) * 0.016666667, atol=1e-12)
    assert list(take["mocap/joint_names"].asstr()) == ["Hips", "Spine", "Hände"]
    assert list(take["mocap/parents"]) == [-1, 0, 1]
    assert take["mocap/rest_offsets"][2, 2] == 1 / 3
    for name in ("mocap/positions", "kinect/positions", "imu/orientation"):
        values = take[name][:]
        assert np.isfinite(values).all() and 0.5 < np.abs(values).max() <= 2, name
    assert {k: take[k].attrs["kind"].decode() for k in ("mocap", "kinect", "imu")} == {
        "mocap": "clip", "kinect": "points", "imu": "imu"}
    assert take.attrs["matlab_dims_reversed"] == 1
    assert take.attrs["subject"] == b"03" and take.attrs["action"] == b"S1A02"
    assert take.attrs["software"].startswith(b"kinalign ")
    assert take["time_ns"].attrs["units"] == b"ns since 1970-01-01T00:00:00 UTC"
    assert take["mocap/positions"].attrs["units"] == b"m"
    assert take["mocap/local_rotations"].attrs["order"] == b"w,x,y,z"
    assert take["imu/acceleration"].attrs["gravity"] == b"included in waist only"
    assert list(take["imu"].attrs["gravity"]) == [b"included", b"removed"]
    assert list(take["imu"].attrs["input_names"]) == [b"w.csv", b"wl.csv"]
    assert list(take["imu"].attrs["input_sha256"]) == [b"c" * 64, b"d" * 64]
    assert json.loads(take["report_json"].asstr()[()])["schema"] == "kinalign.report/1"
    assert json.loads(take["parameters_json"].asstr()[()])["subject"] == "03"
