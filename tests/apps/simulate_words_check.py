# SPDX-License-Identifier: Apache-2.0
"""What simulate says where something is not as it was meant, and what it leaves then.
simulate_words_check.py BUILD_FOLDER [CASE...]"""
import atexit
import json
import pathlib
import re
import signal
import socket
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
from cases import Skip, case, done_with, in_time, kinalign, law, main, refused, wrong
from rehearsing import Recorder, drawn_ports, truth_table

TWO_JOINTS = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation
  JOINT Spine
  {
    OFFSET 0 10 0
    CHANNELS 3 Yrotation Xrotation Zrotation
    End Site
    {
      OFFSET 0 10 0
    }
  }
}
MOTION
Frames: 500
Frame Time: 0.01
""" + 500 * "0 90 0 0 0 0 0 0 0\n"


def page():
    return " ".join(done_with(0, "simulate", "--help")[0].split())


def live(folder, *words):
    """The words of a live rehearsal of 3 s."""
    return "simulate", "built-in", "-o", folder / "r", "--live", "--seconds", "3", *words


# ---- before anything is written

@case
def live_a_skeleton_that_is_no_suits_is_refused_before_a_folder_is_made(folder):
    (folder / "two.bvh").write_text(TWO_JOINTS)
    said = refused("simulate", folder / "two.bvh", "-o", folder / "r", "--live", naming=folder / "two.bvh",
                   out=folder / "r")
    assert said.endswith(" a suit's skeleton with the 59 joints of Noitom's stream, for --live, found 2 joints"), said
    assert "59 joints" in page() and "3 s at least" in page(), page()


@case
def a_motion_that_is_shorter_than_was_asked_for_says_so(folder):
    done_with(0, "simulate", "built-in", "-o", folder / "r", "--seconds", "4")
    motion = folder / "r/truth/motion.bvh"
    said, _ = done_with(0, "simulate", motion, "-o", folder / "longer", "--seconds", "8")
    assert said.splitlines()[1] == "  note    motion.bvh is shorter than --seconds asks for (8.00 s)", said
    for words in (("--seconds", "4"), ("--seconds", "3"), ()):
        said, _ = done_with(0, "simulate", motion, "-o", folder / f"as asked {len(words)}{words[-1:]}", *words)
        assert "note" not in said, said


@case
def a_host_by_name_is_wrong_use_and_leaves_nothing(folder):
    wrong(*live(folder, "--to", "localhost"),
          says="--to: expected an address in numbers, such as 127.0.0.1, found localhost")
    assert not (folder / "r").exists()


@case
def a_host_that_there_is_no_way_to_is_told_and_leaves_nothing(folder):
    alone = ("unshare", "--map-root-user", "--net")
    if subprocess.run([*alone, "true"], capture_output=True, check=False).returncode != 0:
        raise Skip("no network namespace may be made here")
    words = live(folder, "--to", "10.9.9.9")
    done = kinalign(*words, prefix=alone)
    law(done, words, folder / "r")
    assert done.returncode == 3, done.stderr
    assert done.stderr.decode().splitlines() == [
        "kinalign simulate: --to: expected a network route to 10.9.9.9 port 7012, found Network is unreachable",
        "  nothing was written", "  ip route get 10.9.9.9 shows this machine's route to it"], done.stderr


@case
def a_motion_called_nearly_as_the_built_in_one_is_answered_with_its_name(folder):
    for name, near in (("builtin", True), ("built_in", True), ("walk.bvh", False)):
        done = kinalign("simulate", name, "-o", folder / "r", cwd=folder)
        law(done, ["simulate", name], folder / "r")
        assert done.returncode == 3 and ("\n  did you mean built-in?\n" in done.stderr.decode()) == near, done.stderr


# ---- live

@case
def where_nobody_listens_every_device_says_so_alike_and_it_ends_with_1(folder):
    words = live(folder, *drawn_ports())
    done = kinalign(*words)
    said = law(done, words) + done.stdout.decode()
    assert done.returncode == 1, said
    counts = re.findall(r"(\d+) of (\d+) on (\w+) port", said)
    assert [name for *_, name in counts] == ["mocap", "kinect", "imu", "marks"], said
    assert re.search(r"^  the host refused every datagram: is kinalign record running on ports mocap \d+, kinect \d+, imu \d+, "
                     r"marks \d+ of 127\.0\.0\.1\?", said, re.M), said
    assert "next " not in said, said
    in_time(all(int(refusals) > 0.9 * int(sent) for refusals, sent, _ in counts), said)


@case
def two_devices_on_one_port_are_refused_before_anything_is_made(folder):
    out, err = done_with(2, "simulate", "built-in", "-o", folder / "r", "--live", "--mocap-port", 7012, "--kinect-port",
                         7012)
    assert err.startswith("kinalign simulate: --kinect-port: expected a port other than that of --mocap-port, found "
                          "7012\n"), err
    assert not out and not (folder / "r").exists()


@case
def another_program_on_a_port_is_no_recorder(folder):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        words = live(folder, "--mocap-port", other.getsockname()[1], *drawn_ports()[2:])
        done = kinalign(*words)
    said = law(done, words) + done.stdout.decode()
    assert done.returncode == 1 and "no reply came: is kinalign record running on ports " in said, said
    assert "on mocap port" not in said and "on kinect port" in said and "next " not in said, said


@case
def what_is_stopped_says_when_and_names_no_next_step_and_ends_with_130(folder):
    how = ((signal.SIGINT, ()), (signal.SIGTERM, ()), (signal.SIGHUP, ("--json",)))
    recorders = [Recorder(folder / f"takes_{sign.name}") for sign, _ in how]
    running = [(sign, subprocess.Popen(
        [str(cases.PROGRAM), "simulate", "built-in", "-o", str(folder / sign.name), "--live", "--seconds", "30",
         *json_flag, *map(str, recorder.flags())], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))
               for (sign, json_flag), recorder in zip(how, recorders)]
    for _, program in running:
        atexit.register(program.kill)  # where the case fails in the middle
        program.stdout.readline()
    time.sleep(1.5)
    for sign, program in running:
        program.send_signal(sign)
        out, err = program.communicate(timeout=30)
        assert program.returncode == 130 and err == "", (sign, program.returncode, err)
        if sign != signal.SIGHUP:
            assert re.search(r"^  stopped after [0-9]\.\d s of 30\.0 s\n  sent ", out, re.M) and "next " not in out, out
        else:
            sent = json.loads(out)
            assert sent["stopped"] and 0.1 < sent["sent_s"] < 10 and sent["length_s"] == 30, sent
    for recorder in recorders:
        recorder.end()


@case
def the_next_step_names_recording_toml_where_the_recording_is_the_one_it_is_of(folder):
    with subprocess.Popen([str(cases.PROGRAM), *map(str, live(folder, "--begin-in", "2", *drawn_ports()))],
                          stdout=subprocess.PIPE, text=True) as simulation:
        lines = [simulation.stdout.readline() for _ in range(3)]
        done_with(0, "record", "-o", folder / "r", "--config", folder / "r/lab.toml", "--seconds", "6", "--quiet")
        out, _ = simulation.communicate(timeout=30)
    assert simulation.returncode == 0, lines
    assert out.splitlines()[-1] == f"  next    kinalign align {folder}/r/recording.toml -o {folder}/r/take.h5", out


@case
def a_recording_elsewhere_or_of_another_name_is_not_called_by_that_one(folder):
    recorder = Recorder(folder / "takes")
    done = kinalign(*live(folder, *recorder.flags()))
    recorder.end()
    assert done.returncode == 0, done.stderr
    assert done.stdout.decode().splitlines()[-2:] == [
        f"  next    {folder}/r/recording.toml names {folder}/r/take_01.mcap, which does not exist: replace this name by the name of your recording",
        f"          then: kinalign align {folder}/r/recording.toml -o {folder}/r/take.h5"], done.stdout


# ---- against the truth

@case
def a_device_that_the_truth_has_not_is_told_with_those_that_it_has_and_no_table(folder):
    done_with(0, "simulate", "built-in", "-o", folder / "r", "--seconds", "4")
    manifest, own = folder / "r/recording.toml", folder / "r/own.toml"
    done_with(0, "align", manifest, "-o", folder / "take.h5")
    own.write_text(manifest.read_text().replace("stream.mocap", "stream.suit").replace('"mocap"', '"suit"'))
    code, said, rows = truth_table(own, folder / "take.h5", folder / "r/truth/truth.json")
    assert code == 3 and rows == [], said
    assert said == (f"{own}: expected a device that the truth has (mocap, kinect, imu waist, imu wrist_left, "
                    "imu wrist_right, imu ankle_left, imu ankle_right), found suit\n"), said


if __name__ == "__main__":
    sys.exit(main())
