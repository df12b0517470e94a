# SPDX-License-Identifier: Apache-2.0
"""Takes as files of other programs, read again by NumPy, tarfile and our own readers, against h5py.
dataset_export_check.py BUILD_FOLDER [CASE...]"""
import csv
import io
import json
import pathlib
import sys
import tarfile
import tomllib

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import case, kinalign, law, main
from data_sets import answer, contents, done, small_set

NAME = "sub-00_task-S2A01_run-01"
NO_DATE = 946_684_800_000_000_000


def built(folder, takes=1):
    data = small_set(folder, takes=takes, seconds=2)
    done("build", data)
    return data


def exported(folder, data, kind, *words):
    said = answer("export", data, "-o", folder / kind, "--format", kind, *words)
    assert said["lost"] and not [one for one in said["findings"] if one["severity"] == "error"], said
    return folder / kind


def take(data, name=NAME):
    return h5py.File(data / name[:6] / f"{name}_take.h5")


def read_again(folder, path):
    """A file of points or nodes as our own reader has it."""
    ran = kinalign("convert", path, folder / (path.name + ".npz"))
    assert ran.returncode in (0, 1), law(ran, ("convert", path))
    return numpy.load(folder / (path.name + ".npz"))


@case
def npz_and_csv_and_shards_hold_every_number_of_the_take(folder):
    data = built(folder)
    arrays = numpy.load(exported(folder, data, "npz") / f"sub-00/{NAME}.npz")
    tables = exported(folder, data, "csv") / "sub-00"
    shard = tarfile.open(exported(folder, data, "webdataset") / "takes-000000.tar")
    members = {one.name[len(NAME) + 1:]: shard.extractfile(one).read() for one in shard}
    facts = json.loads(members["json"])
    assert (facts["subject"], facts["action"], facts["class"]) == ("00", "S2A01", "S2"), facts
    with take(data) as file:
        for stream in ("mocap", "kinect", "imu"):
            rows = list(csv.reader((tables / f"{NAME}_{stream}.csv").open(encoding="utf-8")))
            columns = {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}
            assert [int(x) for x in columns["time_ns"]] == list(file["time_ns"])
            for key, array in file[stream].items():
                if not isinstance(array, h5py.Dataset) or array.shape[:1] != file["time_ns"].shape:
                    continue
                values = array[:]
                assert (arrays[f"{stream}_{key}"] == values).all(), key
                in_shard = numpy.load(io.BytesIO(members[f"{stream}_{key}.npy"]))
                assert in_shard.dtype == values.dtype and (in_shard == values).all(), key
                found = [column for name, column in columns.items() if name.split(".")[0] == key]
                got = numpy.array(found, dtype=values.dtype).T.reshape(values.shape)
                assert (got == values).all(), (stream, key)
        streams = json.loads((tables / f"{NAME}.json").read_text())["streams"]
        mocap = next(one for one in streams if one["name"] == "mocap")
        assert (numpy.array(mocap["rest_offsets"]) == file["mocap/rest_offsets"]).all()
        assert mocap["arrays"]["positions"]["units"] == "m", mocap["arrays"]


@case
def points_and_nodes_read_back_as_exactly_as_their_format_has_them(folder):
    data = built(folder)
    with take(data) as file:
        kinect, valid = file["kinect/positions"][:], (file["kinect/valid"][:] == 1) & (file["kinect/state"][:] > 0)
        seconds = (file["time_ns"][:] - file["time_ns"][0]) / 1e9
        for kind, exact in (("trc", 1e-7), ("c3d", 3e-7)):
            out = exported(folder, data, kind) / "sub-00"
            back = read_again(folder, out / f"{NAME}_kinect.{kind}")
            seen = back["state"] > 0
            assert (seen == valid).all(), kind
            assert numpy.abs(back["positions"] - kinect)[seen].max() < exact, kind
            joints = read_again(folder, out / f"{NAME}_mocap.{kind}")
            assert numpy.abs(joints["positions"] - file["mocap/positions"][:]).max() < exact, kind
            times = (back["time_ns"] - back["time_ns"][0]) / 1e9
            assert numpy.abs(times - seconds).max() < 1e-4, kind
        nodes = read_again(folder, exported(folder, data, "sto") / f"sub-00/{NAME}_imu.sto")
        assert (nodes["valid"] == file["imu/valid"][:]).all()
        turned = numpy.abs((nodes["orientation"] * file["imu/orientation"][:]).sum(axis=2))[nodes["valid"] == 1]
        assert turned.min() > 1 - 1e-6, turned.min()


@case
def skeletons_read_back_from_bvh_and_mot(folder):
    data = built(folder)
    with take(data) as file:
        clip = read_again(folder, exported(folder, data, "bvh") / f"sub-00/{NAME}_mocap.bvh")
        assert numpy.abs(clip["positions"] - file["mocap/positions"][:]).max() < 2e-6
        lines = (exported(folder, data, "mot") / f"sub-00/{NAME}_mocap.mot").read_text().splitlines()
        head = lines.index("endheader")
        names = lines[head + 1].split("\t")
        rows = numpy.array([[float(x) for x in line.split("\t")] for line in lines[head + 2:]])
        assert rows.shape == (len(file["time_ns"]), len(names)), rows.shape
        root = rows[:, [names.index(f"Hips_t{axis}") for axis in "xyz"]]
        assert numpy.abs(root - file["mocap/positions"][:, 0]).max() < 2e-6


@case
def a_bids_data_set_passes_the_check_and_reads_back(folder):
    data = built(folder, takes=2)
    out = exported(folder, data, "bids")
    people = (out / "participants.tsv").read_text().splitlines()
    assert people[0] == "participant_id\tsex\theight\tweight\thandedness" and len(people) == 3, people
    assert people[1].startswith("sub-00\tM\t175"), people
    motion = out / "sub-00/motion/sub-00_task-S2A01_tracksys-kinect_run-1_motion.tsv"
    with take(data) as file:
        back = read_again(folder, motion)
        seen = back["state"] > 0
        assert seen.any() and numpy.abs(back["positions"] - file["kinect/positions"][:])[seen].max() < 1e-6
        first = int(file["time_ns"][0])
        assert abs(int(back["time_ns"][0]) - first) < 1000, (back["time_ns"][0], first)
    ran = kinalign("check", out, "--json")
    said = json.loads(ran.stdout)["findings"]
    assert ran.returncode == 1 and [one["severity"] for one in said] == ["warning"], said  # no licence
    (motion.parent / motion.name.replace("motion.tsv", "channels.tsv")).unlink()
    said = json.loads(kinalign("check", out, "--json").stdout)["findings"]
    assert any(one["severity"] == "error" and one["file"].endswith("channels.tsv") for one in said), said


@case
def bids_has_no_date_that_is_not_known_and_says_whom_to_cite(folder):
    dated = built(folder)
    toml = dated / "dataset.toml"
    lines = [line for line in toml.read_text().splitlines() if not line.startswith(("citation", "contact"))]
    toml.write_text("\n".join(['citation = "Walks, 2023"', 'contact = "room 12"', *lines]) + "\n")
    points = exported(folder, dated, "trc")
    done("import", folder / "points", points, "--subject", "01")
    done("build", folder / "points")

    def times(data, *words):
        out = exported(folder / f"{data.name}{len(words)}", data, "bids", *words)
        rows = [list(csv.reader(path.open(), delimiter="\t")) for path in out.rglob("*_scans.tsv")]
        assert b"room 12" not in b"".join(path.read_bytes() for path in out.rglob("*") if path.is_file())
        about = json.loads((out / "dataset_description.json").read_text())
        assert about.get("HowToAcknowledge") == ("Walks, 2023" if data == dated else None), about
        return {row[1] for table in rows for row in table[1:]}
    year = {one[:4] for one in times(dated)}
    assert len(year) == 1 and year.pop() >= "2023"
    assert times(dated, "--release") == times(folder / "points") == times(folder / "points", "--release") == {"n/a"}


@case
def a_data_set_of_its_own_is_listed_and_verified_as_it_was_written(folder):
    data = built(folder, takes=2)
    out = exported(folder, data, "take")
    assert done("list", out, "--columns", "all") == done("list", data, "--columns", "all")
    free = exported(folder / "free", data, "take", "--release")
    for one in (out, free):
        said = answer("verify", one, "--deep")
        assert said["takes"] == 2 and {f["severity"] for f in said["findings"]} <= {"note"}, said
        assert answer("build", one)["up_to_date"] == 2
    assert [row["begin_ns"] for row in answer("list", free, "--columns", "begin_ns")["takes"]] == [NO_DATE] * 2
    summaries = sorted(free.rglob("*_take.json"))
    summaries[0].unlink()
    summaries[1].write_text("{")
    said = [(one["file"], one["expected"], one["found"]) for one in answer("verify", free, code=1)["findings"]
            if one["severity"] == "error"]
    assert said[0] == (str(summaries[0].relative_to(free)), "a summary next to the take", "no summary"), said
    assert len(said) == 2 and said[1][1].startswith("a summary that can be read: ") and said[1][2] != "none", said
    assert (out / f"sub-00/{NAME}_take.h5").read_bytes() == (data / f"sub-00/{NAME}_take.h5").read_bytes()
    done("build", out)
    answer("verify", out, "--deep")
    assert len(answer("list", out)["takes"]) == 2


@case
def a_release_has_no_dates_and_no_names_and_is_refused_where_a_text_gives_a_person_away(folder):
    data = built(folder)
    toml = data / "dataset.toml"
    toml.write_text("# 00 is Anna Schmidt\n" + toml.read_text())
    manifest, = data.glob("sub-00/*_recording.toml")
    text = manifest.read_text()
    day = "1790000000"  # of the demo's start
    assert f"start_ns = {day}" in text, text
    out = exported(folder, data, "take", "--release")
    for path in filter(pathlib.Path.is_file, out.rglob("*")):
        written = path.read_bytes()
        assert day.encode() not in written and b"Anna" not in written, path
        assert int(day).to_bytes(4, "little") not in written or path.suffix == ".h5", path
    assert sorted(tomllib.loads((out / "dataset.toml").read_text())["subject"]) == ["00"]
    with take(data) as file, take(out) as free:
        assert free["time_ns"][0] == NO_DATE
        assert (numpy.diff(free["time_ns"]) == numpy.diff(file["time_ns"])).all()
        assert (free["kinect/positions"][:] == file["kinect/positions"][:]).all()
        assert list(free["kinect"].attrs["input_names"].astype(str)) == ["kinect.csv"]
        report = json.loads(free["report_json"][()])
        assert abs(report["begin_ns"] - NO_DATE) < 1_000_000_000, report["begin_ns"]
        assert {stream["stamps"]["first_ns"] for stream in report["streams"]} == {0}, report["streams"]
    bids = exported(folder, data, "bids", "--release")
    assert (bids / "participants.tsv").read_text().splitlines()[0] == "participant_id"
    toml.write_text(toml.read_text() + '\n[device.kinect]\nserial = "A22596V01234"\n')
    ran = kinalign("dataset", "export", data, "-o", folder / "named", "--format", "npz", "--release", "--json")
    assert ran.returncode == 1 and not (folder / "named").exists(), ran
    assert "serial" in ran.stdout.decode(), ran.stdout


@case
def an_export_that_would_write_no_file_fails_and_leaves_nothing(folder):
    points = exported(folder, built(folder), "trc")
    data = folder / "points"
    done("import", data, points, "--subject", "01")
    done("build", data)
    for kind, needs in (("bvh", "a skeleton"), ("mot", "a skeleton"), ("sto", "nodes with orientations")):
        ran = kinalign("dataset", "export", data, "-o", folder / "none", "--format", kind)
        said = law(ran, ("dataset", "export"), folder / "none")
        assert ran.returncode == 3 and f"expected {needs} in at least one take, for {kind}, found no take with them" in said, said
        assert not list(folder.glob("none*")), said
    exported(folder / "all", data, "npz")


@case
def what_is_there_is_not_touched_and_a_failure_leaves_nothing(folder):
    data = built(folder)
    (folder / "there").mkdir()
    (folder / "there/mine").write_text("x")
    ran = kinalign("dataset", "export", data, "-o", folder / "there")
    assert ran.returncode == 3 and contents(folder / "there"), ran
    whole = data / f"sub-00/{NAME}_take.h5"
    bytes_ = whole.read_bytes()
    whole.write_bytes(bytes_[:len(bytes_) // 2])
    ran = kinalign("dataset", "export", data, "-o", folder / "half")
    assert ran.returncode == 3 and not list(folder.glob("half*")), ran
    whole.write_bytes(bytes_)


if __name__ == "__main__":
    sys.exit(main())
