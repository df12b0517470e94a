# SPDX-License-Identifier: Apache-2.0
"""Opens the files of tests/formats/take/take_npz_test.cpp as a user would; numpy checks every checksum."""
import sys
import zipfile

import numpy as np

folder = sys.argv[1]
for name in ("take", "clip", "empty"):
    with zipfile.ZipFile(f"{folder}/{name}.npz") as archive:
        assert archive.testzip() is None
        assert all(one.date_time == (1980, 1, 1, 0, 0, 0) for one in archive.infolist())
        assert all(one.flag_bits == 0 and one.compress_type == 0 for one in archive.infolist())
clip = np.load(f"{folder}/clip.npz", allow_pickle=False)
assert set(clip) == {"time_ns", "positions", "local_positions", "local_rotations", "joint_names", "parents",
                     "rest_offsets", "end_sites_parents", "end_sites_offsets"}, set(clip)
assert list(clip["joint_names"]) == ["Hips", "Spine", "Hände"] and clip["joint_names"].dtype == "<U5"
assert clip["positions"].shape == (50, 3, 3) and clip["positions"].dtype == "<f4"
assert clip["local_rotations"].shape == (50, 3, 4)
assert clip["parents"].tolist() == [-1, 0, 1] and clip["rest_offsets"][2, 2] == 1 / 3
assert (np.diff(clip["time_ns"]) == 16_666_667).all()
take = np.load(f"{folder}/take.npz", allow_pickle=False)
assert (take["mocap_positions"] == clip["positions"]).all()
assert take["imu_orientation"].shape == (50, 2, 4) and "imu_angular_velocity" not in take
assert take["kinect_state"].dtype == "|u1" and take["kinect_state"].max() == 2
assert take["imu_nearest_raw_ns"].shape == (50, 2) and "imu_time_interval_ns" not in take
assert list(take["imu_node_names"]) == ["waist", "wrist_left"]
empty = np.load(f"{folder}/empty.npz", allow_pickle=False)
assert empty["positions"].shape == (0, 3, 3) and empty["parents"].shape == (3,)
