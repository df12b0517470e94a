# SPDX-License-Identifier: Apache-2.0
"""Copies of a take, each altered in one place, as another program could: take.h5 of a folder becomes a
file for each alteration that tests/formats/take/altered_test.cpp names."""
import pathlib
import shutil
import sys

import h5py
import numpy as np


def put(file, name, value, **how):
    attributes = dict(file[name].attrs)
    del file[name]
    file.create_dataset(name, data=value, **how)
    file[name].attrs.update(attributes)


def shape(file, name, sizes):
    put(file, name, np.zeros(sizes, file[name].dtype))


def link(file, name, to):
    del file[name]
    file[name] = to


def change(file, name, at, value):
    file[name][at] = value


def attribute(file, group, name, value):
    file[group].attrs[name] = value


fixed = np.bytes_
alterations = {
    "no stamps": lambda f: f.__delitem__("time_ns"),
    "stamps of seconds": lambda f: put(f, "time_ns", f["time_ns"][:] * 1e-9),
    "one stamp": lambda f: put(f, "time_ns", np.int64(5)),
    "stamps that stand": lambda f: change(f, "time_ns", 7, f["time_ns"][6]),
    "chunks": lambda f: put(f, "mocap/positions", f["mocap/positions"][:], chunks=(5, 3, 3)),
    "compression": lambda f: put(f, "mocap/positions", f["mocap/positions"][:], compression="gzip"),
    "a soft link": lambda f: link(f, "mocap/positions", h5py.SoftLink("/mocap/local_positions")),
    "another file's array": lambda f: link(f, "mocap/positions", h5py.ExternalLink("take.h5", "/mocap/positions")),
    "five dimensions": lambda f: shape(f, "mocap/positions", (20, 3, 3, 1, 1)),
    "four joints": lambda f: shape(f, "mocap/positions", (20, 4, 3)),
    "a row less": lambda f: shape(f, "kinect/valid", (19, 2)),
    "a great array without bytes": lambda f: (f.__delitem__("kinect/positions"), f.create_dataset(
        "kinect/positions", (20, 2**40, 3), "<f4")),
    "double where float is stored": lambda f: put(f, "kinect/positions", f["kinect/positions"][:].astype("<f8")),
    "numbers the other way round": lambda f: put(f, "kinect/positions", f["kinect/positions"][:].astype(">f4")),
    "no orientations' validity": lambda f: f.__delitem__("imu/valid"),
    "texts of any length": lambda f: put(f, "mocap/joint_names", ["a", "b", "c"], dtype=h5py.string_dtype()),
    "one joint name": lambda f: put(f, "kinect/joint_names", fixed("SpineBase")),
    "joints of one name": lambda f: put(f, "kinect/joint_names", np.array([b"Head", b"Head"])),
    "a list of parameters": lambda f: put(f, "parameters_json", np.array([b"{}"])),
    "parameters of another key": lambda f: put(f, "parameters_json", fixed(
        '{"schema": "kinalign.parameters/1", "colour": "red"}')),
    "no kind": lambda f: f["kinect"].attrs.__delitem__("kind"),
    "another kind": lambda f: attribute(f, "kinect", "kind", fixed("ghost")),
    "another format": lambda f: attribute(f, "/", "format", fixed("kinalign.take/2")),
    "no format": lambda f: f.attrs.__delitem__("format"),
    "a number for software": lambda f: attribute(f, "/", "software", 3),
    "a subject of any length": lambda f: attribute(f, "/", "subject", "03"),
    "a stream twice": lambda f: attribute(f, "/", "streams", np.array([b"mocap", b"mocap"])),
    "a hash less": lambda f: attribute(f, "imu", "input_sha256", np.array([b"c" * 64])),
    "no sizes of inputs": lambda f: attribute(f, "imu", "input_bytes", np.zeros(0, "<u8")),
    "a child before its parent": lambda f: change(f, "mocap/parents", 1, 2),
    "an end site of no joint": lambda f: change(f, "mocap/end_sites/parents", 0, 3),
    "a place that is no number": lambda f: change(f, "kinect/positions", (19, 1, 2), np.nan),
    "an endless turn": lambda f: change(f, "mocap/local_rotations", (0, 0, 0), np.inf),
    "a distance below zero": lambda f: change(f, "kinect/nearest_raw_ns", 3, -1),
    "a fourth state": lambda f: change(f, "kinect/state", (0, 0), 3),
    "more than valid": lambda f: change(f, "imu/valid", (0, 0), 2),
    "more than we know": lambda f: (f.create_dataset("mocap/velocities", data=np.ones((20, 3, 3)), compression="gzip"),
                                    f.create_group("notes").create_dataset("text", data="mine"),
                                    attribute(f, "kinect", "seen_by", "me")),
}
folder = pathlib.Path(sys.argv[1])
for name, alter in alterations.items():
    shutil.copy(folder / "take.h5", folder / f"{name}.h5")
    with h5py.File(folder / f"{name}.h5", "r+") as take:
        alter(take)
