# SPDX-License-Identifier: Apache-2.0
"""A lab that can't be recorded as it is said: which part of it, and what to do.
record_refusals_check.py BUILD_FOLDER [CASE...]"""
import json
import os
import pathlib
import shutil
import socket
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from cases import Skip, case, done_with, kinalign, main, wrong
from recording_program import Recording

PAGES = "docs/commands.md describes a settings file, docs/formats/lab_toml.md describes a lab file"
HELP = "kinalign record --help lists its arguments and flags, with examples"


def refusal(code, folder, *words, **how):
    """What a call of record says that ends with this exit code, notes left out; nothing is made."""
    done = kinalign("record", "-o", folder / "takes", *words, **how)
    assert done.returncode == code and done.stdout == b"", done
    lines = [line for line in done.stderr.decode().splitlines() if not line.startswith("note: ")]
    assert lines[0].startswith("kinalign record: "), lines
    return [lines[0].removeprefix("kinalign record: "), *(line.removeprefix("  ") for line in lines[1:])]


def lab(folder, text):
    (folder / "lab.toml").write_text(text)
    return "--config", folder / "lab.toml"


@case
def a_file_of_settings_that_cannot_be_read_is_no_wrong_use(folder):
    none = folder / "none.toml"
    says = f"{none}: expected a readable file, found No such file or directory"
    assert refusal(3, folder, "--config", none) == [says]
    assert refusal(3, folder, env={"KINALIGN_CONFIG": str(none)}) == [says, "the variable KINALIGN_CONFIG names this file"]
    assert refusal(3, folder, "--config", folder)[0].startswith(f"{folder}: expected"), "a folder"
    for verb in (("check", "x.bvh"), ("align", "x.toml", "-o", "x.h5")):  # of every verb
        done = kinalign(*verb, "--config", none, cwd=folder)
        assert (done.returncode, done.stderr.decode()) == (3, f"kinalign {verb[0]}: {says}\n"), done


@case
def a_file_is_no_folder(folder):
    wrong("record", "-o", folder / "take.mcap", "--device", "m=noitom:0",
          says=f"--out: expected a folder for the files; --subject and --action make their names, found {folder}/take.mcap")
    (folder / "here").write_text("no folder")
    _, err = done_with(3, "record", "-o", folder / "here" / "takes", "--device", "m=nodes:0")
    assert f"{folder}/here/takes: expected a folder that can be made, found Not a directory" in err, err


@case
def a_hosts_name_and_nodes_over_tcp_are_wrong_use(folder):
    says = "expected an IP address (getent hosts NAME shows the address of a host), found mocap-pc"
    assert refusal(2, folder, "--device", "mocap=noitom:tcp:mocap-pc:7001") == [f"mocap: {says}", HELP]
    config = lab(folder, '[record]\npre_roll_s = 1\n[device.mocap]\nprotocol = "noitom"\ntransport = "tcp"\n'
                         'address = "mocap-pc"\nport = 7001\n')
    assert refusal(2, folder, *config) == [f"{config[1]}:3: {says}", PAGES]
    for device in ("imu=nodes:tcp:5005", "imu=nodes:tcp-listen:5005"):
        assert refusal(2, folder, "--device", device)[0].startswith(
            "imu: expected transport udp, the only one of protocol nodes, found tcp"), device


@case
def a_port_for_marks_that_is_a_devices_is_wrong_use(folder):
    config = lab(folder, '[device.kinect]\nprotocol = "kinect"\nport = 7201\n')
    for flag in ("--marks-port", "--trigger-port"):
        says = [f"{flag}: expected another UDP port than that of device", "found 7201"]
        assert refusal(2, folder, "--device", "imu=nodes:7201", flag, 7201) == [f"{says[0]} imu, {says[1]}", HELP]
        assert refusal(2, folder, *config, flag, 7201) == [f"{says[0]} kinect, {says[1]}", HELP]
    config = lab(folder, '[device.kinect]\nprotocol = "kinect"\nport = 7201\n[record]\nmarks_port = 7201\n')
    says = "expected another UDP port than that of device kinect, found 7201"  # no flag is blamed that nobody gave
    assert refusal(2, folder, *config) == [f"{config[1]}:5: {says}", PAGES]
    assert refusal(2, folder, *config, env={"KINALIGN_MARKS_PORT": "7201"}) == [f"KINALIGN_MARKS_PORT: {says}", HELP]
    assert refusal(2, folder, *config, "--marks-port", 7201) == [f"--marks-port: {says}", HELP]
    recording = Recording(folder / "takes", "--marks-port", "0", "--trigger-port", "0", "--seconds", "0")
    recording.program.communicate(timeout=60)
    assert recording.program.returncode == 1, "any free ones are others"


@case
def a_port_that_is_taken_is_told_with_its_device_and_what_takes_another(folder):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as udp, socket.socket() as tcp:
        udp.bind(("127.0.0.1", 0))
        tcp.bind(("127.0.0.1", 0))
        tcp.listen()
        taken, listened = udp.getsockname()[1], tcp.getsockname()[1]
        config = lab(folder, f'[device.kinect]\nprotocol = "kinect"\nport = {taken}\n')
        mocap = ("--device", "mocap=noitom:udp:127.0.0.1:0")
        for words, name, place, remedy in (
                (("--device", f"mocap=noitom:udp:127.0.0.1:{taken}"), "mocap",
                 f"UDP port to serve on at 127.0.0.1:{taken}", "--device mocap=noitom:udp:PORT"),
                (("--device", f"imu=nodes:{taken}"), "imu", f"UDP port to serve on at 0.0.0.0:{taken}",
                 "--device imu=nodes:udp:PORT"),
                (("--device", f"kinect=kinect:tcp-listen:127.0.0.1:{listened}"), "kinect",
                 f"TCP port to serve on at 127.0.0.1:{listened}", "--device kinect=kinect:tcp-listen:PORT"),
                (config, "kinect", f"UDP port to serve on at 0.0.0.0:{taken}",
                 f"port of [device.kinect] in {config[1]}"),
                ((*mocap, "--marks-port", taken), "marks", f"UDP port to serve on at 0.0.0.0:{taken}", "--marks-port"),
                ((*mocap, "--trigger-port", taken), "trigger", f"UDP port to serve on at 0.0.0.0:{taken}",
                 "--trigger-port")):
            port, ss = place.rsplit(":", 1)[1], "-tlpn" if place.startswith("TCP") else "-ulpn"
            assert refusal(3, folder, *words) == [
                f"{name}: expected a {place}, found a port that another program uses",
                f"ss {ss} 'sport = :{port}' shows which program uses it, perhaps another kinalign; {remedy} sets another port"]
    said = refusal(3, folder, "--device", "mocap=noitom:udp:192.0.2.77:7012")
    assert said[1] == ("ip -brief address shows this machine's addresses; --device mocap=noitom:udp:ADDRESS:PORT accepts any of them"), said


@case
def port_30_without_rights_is_told_with_what_to_do(folder):
    if int(pathlib.Path("/proc/sys/net/ipv4/ip_unprivileged_port_start").read_text()) <= 30:
        raise Skip("this machine lets anybody serve on port 30")
    if os.getuid() == 0 and not shutil.which("setpriv"):
        raise Skip("no setpriv")
    prefix = ("setpriv", "--reuid", "65534", "--clear-groups") if os.getuid() == 0 else ()
    folder.chmod(0o777)
    said = refusal(3, folder, "--device", "mocap=noitom:0", "--trigger-port", 30, prefix=prefix)
    assert said[0] == ("trigger: expected a UDP port to serve on at 0.0.0.0:30, found no permission for a port below "
                       "1024"), said
    assert "setcap" in said[1] and said[2].startswith("--trigger-port sets a port from 1024 on"), said


@case
def what_is_wrong_in_a_lab_is_told_with_its_line_and_the_page_that_shows_the_keys(folder):
    for text, says in (('[device.a]\nprotocol = "nodes"\n[devices.mocap]\nport = 1\n',
                        ":3: expected settings, or a lab's device as [device.mocap], found [devices.mocap]"),
                       ("[device.mocap]\nprt = 1\n", ":2: expected a key of [device.mocap] (nearest: port), found \"prt\""),
                       ('[align]\ngap_ms = 50\n[space.kinect]\nmethod = "fit"\n',
                        ":3: expected settings, or a lab's devices, found [space.kinect], which belongs in a manifest for kinalign align"),
                       ('[device.a]\nprotocol = "nodes"\nport = 0\nnodes = { "1" = "2" }\n',
                        ":1: expected the name of a place, such as waist: a number may be another node's id, found 2 of node 1"),
                       ("[device]\nport = 1\n",
                        ":2: expected [device.NAME], a table of its own for each, found port, 1")):
        config = lab(folder, text)
        assert refusal(2, folder, *config) == [f"{config[1]}{says}", PAGES]


@case
def a_devices_name_stands_in_advice_as_toml_wants_it(folder):
    recording = Recording(folder / "takes", "--seconds", "0", device="a b=noitom:udp:127.0.0.1:0")
    _, said = recording.program.communicate(timeout=60)
    assert 'under [device."a b"] of a lab.toml' in said, said


@case
def a_file_that_a_device_needs_is_told_with_the_device_and_the_key_that_names_it(folder):
    config = lab(folder, '[device.mocap]\nprotocol = "noitom"\nport = 0\nskeleton = "rig.bvh"\n')
    names = f"skeleton of [device.mocap] in {config[1]} names it"
    rig = folder / "rig.bvh"
    assert refusal(3, folder, *config) == [f"{rig}: expected a readable file, found No such file or directory", names]
    rig.write_text("HIERARCHIE\n")
    assert refusal(3, folder, *config) == [f"{rig}:1: expected HIERARCHY, found 'HIERARCHIE'", names]
    config = lab(folder, '[device.imu]\nprotocol = "nodes"\nport = 0\nlab_key = "lab.key"\n')
    key, names = folder / "lab.key", f"lab_key of [device.imu] in {config[1]} names it"
    says, *more = refusal(3, folder, *config)
    assert says == f"{key}: expected a lab key, found No such file or directory" and more[0] == names, (says, more)
    assert "--new-lab-key FILE makes the lab's key" in more[1], more
    key.write_text("12\n")
    key.chmod(0o600)
    assert refusal(3, folder, *config)[1] == names
    assert names not in refusal(3, folder, *config, "--lab-key", key), "a flag names it"


@case
def a_lab_is_no_manifest(folder):
    path = lab(folder, '[device.mocap]\nprotocol = "noitom"\nport = 7012\n')[1]
    for words in (("align", path, "-o", folder / "take.h5"), ("info", path), ("check", path)):
        done = kinalign(*words)
        assert done.returncode == 3 and done.stderr.decode().splitlines()[0] == (
            f"kinalign {words[0]}: {path}:1: expected a manifest, recording.toml, with [stream.NAME], found [device], "
            "of a lab.toml: kinalign record takes it as --config"), done


@case
def a_call_for_a_mark_that_is_refused_is_answered_with_the_cause(folder):
    recording = Recording(folder / "takes", "--marks-port", "0")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as caller:
        caller.settimeout(30)
        for call, answer in (({"kind": "pause", "id": "7"}, {"mark": "7", "is": "wrong_kind"}),
                             ({"kind": "stop"}, {"is": "wrong_id"}),
                             ({"kind": "stop", "id": "7"}, {"mark": "7", "is": "new"})):
            sent = json.dumps({"schema": "kinalign.mark/1", **call}).encode()
            caller.sendto(sent, ("127.0.0.1", recording.started["ports"]["marks"]))
            came = caller.recv(2000)
            assert json.loads(came) == answer and len(came) <= len(sent), came
    _, events, _ = recording.end()
    assert events[-1]["ports"]["marks"]["refused_for"] == {"wrong_id": 1, "wrong_kind": 1}, events[-1]


if __name__ == "__main__":
    sys.exit(main())
