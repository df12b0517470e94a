# SPDX-License-Identifier: Apache-2.0
"""Methods for poses and fusion held against each other, as users do it. eval_check.py BUILD_FOLDER [CASE...]"""
import csv
import io
import json
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import time

import numpy
from scipy.stats import wilcoxon

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import data_sets
from cases import BUILD, PROGRAM, Skip, case, kinalign, law, main, refused, wrong
from posed import cmu_people

LEARN = BUILD / "apps/kinalign-learn/kinalign-learn"
DENOISER = pathlib.Path(__file__).resolve().parents[2] / "tests/data/fuzz/denoise_model_fuzz/one.safetensors"


def people(folder):
    if not LEARN.exists():
        raise Skip("kinalign-learn was not built: it needs libtorch-dev")
    return cmu_people(folder)


def compared(*words):
    """What eval says as JSON. LibTorch alone maps a gigabyte."""
    words = ("eval", *words, "--jobs", "1", "--json")
    ran = kinalign(*words, memory=1 << 36, seconds=400)
    said = law(ran, words)
    assert ran.returncode == 0, said
    return json.loads(ran.stdout)


def rows_by_learn(folder, results, model, learnt):
    """What kinalign-learn itself prints of a model."""
    job = folder / "job.json"
    job.write_text(json.dumps({"schema": "kinalign.training_job/1", "windows": str(results / "windows.npz"),
                               "evaluate": str(model), "learn": learnt, "threads": 1}))
    ran = subprocess.run([LEARN, job], capture_output=True, text=True, check=True)
    return [row for row in map(json.loads, ran.stdout.splitlines()) if "warning" not in row]


def trained_models(results):
    """By method and the person who is tested: the takes that were learnt from, and the model."""
    out = {}
    for job in map(json.loads, (path.read_text() for path in results.glob("models/*/job.json"))):
        tested, = {"01", "02", "03"} - {take[4:6] for take in job["learn"]}
        out[job["method"], tested] = (job["learn"], job["out"])
    return out


@case
def two_methods_make_a_table_of_people_with_the_figures_of_kinalign_learn(folder):
    results = folder / "results"
    said = compared("wouda", "dip", "--steps", "2", "--data", people(folder), "-o", results, "--folds", "people")
    assert [row["method"] for row in said["rows"]] == ["wouda", "dip"], said["rows"]
    models = trained_models(results)
    assert len(models) == 6, models
    people_rows = {(row["method"], row["tested"]): row for row in said["people"]}
    assert set(people_rows) == set(models), people_rows.keys()
    for (method, person), (learnt, model) in list(models.items())[:3]:
        rows = {row["nodes"]: row for row in rows_by_learn(folder, results, model, learnt)}
        ours = people_rows[method, person]
        for mark, key in (("sip_deg", "sip_deg"), ("angle_deg", "angle_deg"), ("head_deg", "head_deg"),
                          ("position_cm", "position_cm"), ("jitter_ratio", "jitter")):
            assert ours[key] == rows["calibrated"]["people"][person][mark] == rows["calibrated"]["smoothed"][mark], key
        assert ours["later_position_cm"] == rows["20 minutes later"]["smoothed"]["position_cm"], ours
        assert ours["lost_sip_deg"] == rows["wrist_left lost"]["smoothed"]["sip_deg"], ours
    values = {method: numpy.array([people_rows[method, person]["position_cm"] for person in ("01", "02", "03")])
              for method in ("wouda", "dip")}
    for row in said["rows"]:
        assert abs(row["position_cm"] - values[row["method"]].mean()) < 1e-12, row
        assert abs(row["position_cm_sd"] - values[row["method"]].std()) < 1e-12, row
    test, = (test for test in said["tests"] if test["mark"] == "position_cm")
    assert (test["first"], test["second"], test["pairs"]) == ("wouda", "dip", 3), test
    assert abs(test["difference"] - (values["wouda"] - values["dip"]).mean()) < 1e-12, test
    assert abs(test["p"] - wilcoxon(values["wouda"], values["dip"]).pvalue) < 1e-12, test
    table = list(csv.DictReader(io.StringIO((results / "table.csv").read_text())))
    assert [float(row["position_cm"]) for row in table] == [row["position_cm"] for row in said["rows"]], table
    assert "wouda & " in (results / "table.tex").read_text() and "| dip |" in (results / "table.md").read_text()


@case
def a_run_that_was_stopped_goes_on_from_its_cache(folder):
    data, results = people(folder), folder / "results"
    words = ("wouda", "--data", data, "-o", results)
    stopped = subprocess.Popen([PROGRAM, "eval", *map(str, words), "--jobs", "1"], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
    end = time.monotonic() + 200
    while not list(results.glob("cache/*.json")) and time.monotonic() < end:
        time.sleep(0.05)
    stopped.send_signal(signal.SIGINT)
    out, _ = stopped.communicate(timeout=60)
    assert stopped.returncode == 130 and out == b"", stopped.returncode
    kept = {path: path.stat().st_mtime_ns for path in results.glob("cache/*.json")}
    assert 0 < len(kept) < 3, kept
    first = compared(*words)
    assert all(path.stat().st_mtime_ns == at for path, at in kept.items()), "computed again"
    assert len(list(results.glob("cache/*.json"))) == 3
    shutil.rmtree(results / "models")
    assert compared(*words) == first
    assert not (results / "models").exists(), "trained again"
    shutil.rmtree(results)
    assert compared(*words) == first, "not the same without the stop"


def constant_model(model, out):
    """The same network with weights of 0: it answers with upright bones, whatever the nodes say."""
    data = bytearray(model.read_bytes())
    end = 8 + struct.unpack("<Q", data[:8])[0]
    for name, tensor in json.loads(data[8:end]).items():
        if name.startswith("net."):
            begin, last = (end + place for place in tensor["data_offsets"])
            data[begin:last] = bytes(last - begin)
    out.write_bytes(data)


def angle(z_deg, x_deg):
    """Of a turn about x and then one about z, degrees."""
    z, x = numpy.radians(z_deg) / 2, numpy.radians(x_deg) / 2
    return numpy.degrees(2 * numpy.arccos(numpy.cos(z) * numpy.cos(x)))


@case
def a_finished_model_on_a_split_has_the_error_that_follows_from_the_BVH(folder):
    data, results, model = people(folder), folder / "results", folder / "constant.safetensors"
    data_sets.done("split", data, "--by", "subject", "--test", "0.3", "-o", data / "people.json")
    parts = json.loads((data / "people.json").read_text())["parts"]
    tested, = (take["name"] for part in parts if part["name"] == "test" for take in part["takes"])
    compared("wouda", "--data", data, "--split", data / "people.json", "-o", results)
    constant_model(next(results.glob("models/*/model.safetensors")), model)
    said = compared("wouda", "--model", model, "--data", data, "--split", data / "people.json", "-o", results)
    assert [row["method"] for row in said["rows"]] == ["wouda", str(model)], said["rows"]
    assert "was trained on" not in (results / "table.md").read_text()
    row = said["rows"][1]
    person = int(tested[4:6])
    assert [one["tested"] for one in said["people"]] == [f"{person:02}"] * 2, said["people"]
    # posed.cmu_bvh(): frames 4, 6, ... of 60 Hz; arms turn about z, a thigh about z and x.
    frames = numpy.arange(4, 240 + person - 4, 2)
    swing = numpy.sin(frames / 20 + person)
    sip = numpy.concatenate([angle(-60 + 20 * swing, 0), angle(60 + 20 * swing, 0), angle(-18, 25 * swing),
                             angle(18, 0 * swing)]).mean()
    assert abs(row["sip_deg"] - sip) < 1e-3 and abs(row["lost_sip_deg"] - sip) < 1e-3, (row, sip)
    assert row["jitter"] < 1e-3, row


@case
def a_model_that_is_tested_on_people_of_its_training_is_named_in_the_caption(folder):
    data, results = people(folder), folder / "results"
    model = folder / "all.safetensors"
    words = ("train", "wouda", "--data", data, "-o", model, "--jobs", "1")
    assert kinalign(*words, memory=1 << 36, seconds=400).returncode == 0
    compared("--model", model, "--data", data, "-o", results)
    caption = (results / "table.md").read_text()
    assert "all.safetensors was trained on people of the test part: 01, 02, 03" in caption, caption


@case
def methods_that_fuse_stand_beside_the_filter_by_device(folder):
    results = folder / "results"
    said = compared("bilstm", "bilstm-nodes", "--steps", "1", "--data", people(folder), "-o", results)
    labels = [row["method"] for row in said["rows"]]
    assert sorted(labels) == sorted(f"{method}, {devices}" for method in ("bilstm", "bilstm-nodes", "filter")
                                    for devices in ("both", "kinect", "nodes")), labels
    rows = {row["method"]: row for row in said["rows"]}
    assert 3 < rows["filter, both"]["position_cm"] < rows["filter, nodes"]["position_cm"] < 40, rows
    assert all(row["heading_deg"] is None for row in said["rows"]), "sessions of 4 s have no heading after 60 s"
    (learnt, model), = (one for (method, person), one in trained_models(results).items() if (method, person) == ("bilstm", "02"))
    by_learn = {(row["method"], row["devices"]): row for row in rows_by_learn(folder, results, model, learnt) if "devices" in row}
    ours = {row["method"]: row for row in said["people"] if row["tested"] == "02"}
    for mark, key in (("all_cm", "position_cm"), ("hidden_cm", "hidden_cm"), ("seen_arms_cm", "seen_arms_cm"), ("sip_deg", "sip_deg")):
        assert ours["bilstm, kinect"][key] == by_learn["bilstm", "kinect"]["people"]["02"][mark], mark
        assert ours["filter, both"][key] == by_learn["filter", "both"]["people"]["02"][mark], mark
    pairs = {(test["first"], test["second"]) for test in said["tests"]}
    assert ("bilstm, both", "bilstm, kinect") in pairs and ("bilstm, both", "filter, both") in pairs, pairs
    assert ("bilstm, both", "filter, kinect") not in pairs, pairs


@case
def methods_of_two_tasks_make_no_table(folder):
    both = "expected methods and models of one task, one table for each, found "
    wrong("eval", "refine", "dip", "--data", "d", "-o", "r",
          says=f"METHOD: {both}refine, which cleans a Kinect, and dip, which computes a pose from nodes")
    wrong("eval", "wouda", "--model", DENOISER, "--data", "d", "-o", folder / "r",
          says=f"METHOD: {both}wouda, which computes a pose from nodes, and {shown(DENOISER)}, which cleans a Kinect")
    wrong("eval", "raw", "--nodes", "waist", "--data", "d", "-o", "r",
          says="--nodes: expected a method for poses or for fusion, found raw")
    wrong("eval", "dip", "--windows", "w.npz", "--split", "s.json", "-o", "r",
          says="--split: expected a data set (--data) without other folds, found --windows (--folds split uses the file's own parts)")
    refused("eval", "--model", folder / "none.safetensors", "--data", "d", "-o", folder / "r", naming=folder / "none.safetensors")


def shown(path):
    """As a message shows a long text: cut behind 40 bytes."""
    text = str(path)
    return text if len(text) <= 40 else text[:40] + "..."


sys.exit(main())
