// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/program.h"
#include "apps/kinalign/record/record_run.h"
#include "apps/kinalign/record/steady_memory.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <utility>

namespace kinalign {

namespace {

// Memory for messages that wait for a slow disk, taken before the recording begins.
constexpr std::size_t waiting_room = std::size_t{16} << 20;

/// The command line of `kinalign record`, with the checks that need several flags.
Usage describe_record(RecordJob& o) {
  Usage usage;
  usage.flags = {
      {"device", "NAME=PROTOCOL[:TRANSPORT[:ADDRESS]]:PORT, as in imu=nodes:5005; may be repeated",
       &o.devices},
      {"subject", "who moves: part of the file's name", &o.subject},
      {"action", "what they do: part of the file's name", &o.action},
      {"seconds", "end by itself after so long", &o.seconds, 0.0, 1e6},
      {"wait", "wait for a mark that starts the take; one that stops ends it", &o.wait},
      {"repeat", "with --wait: then wait for the next take, until Ctrl-C", &o.repeat}};
  usage.settings = {
      {"lab_key", "file of the key that the nodes' keys come from", &o.lab_key},
      {"marks_port", "UDP port for marks of other programs; 0: any free one", &o.marks_port, 0.0,
       65535.0},
      {"trigger_port", "UDP port for Vicon's start and stop, usually 30", &o.trigger_port, 0.0,
       65535.0},
      {"live_port", "TCP port of this machine for pose --live and the like; 0: any free one",
       &o.live_port, 0.0, 65535.0}};
  for (const Field& field : describe(o.options)) usage.settings.push_back(field);
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    // The checks here need no file. Those that need lab.toml are in session_options().
    if (common.out.empty()) return Failure(Error{"--out", 0, "a folder for the files", "none"});
    if (common.out.ends_with(".mcap")) {
      return Failure(Error{"--out", 0,
                           "a folder for the files, whose names --subject and --action say",
                           common.out});
    }
    if (o.marks_port && o.marks_port == o.trigger_port && o.marks_port != 0) {
      return Failure(Error{"--trigger-port", 0, "another port than --marks-port",
                           std::to_string(*o.trigger_port)});
    }
    if (o.repeat && !o.wait) {
      return Failure(Error{"--repeat", 0, "--wait beside it: takes need a start", "none"});
    }
    RecordJob flags = o;  // ports of marks are checked later, together with the devices of the file
    flags.marks_port.reset();
    flags.trigger_port.reset();
    // The call is for its error: a wrong --device is wrong use.
    KA_TRY(lab_of(flags, {}));
    return {};
  };
  return usage;
}

/// Records until the end. From its beginning on signals are only noted, so that Ctrl-C ends
/// a recording in order.
Result<int> run(RecordJob& o, Call& call) {
  Console& console = call.console;
  // The order matters: outputs never wait, then signals are noted, then memory is taken, all before
  // the first thread and socket.
  console.never_wait();
  take_every_signal();
  keep_memory(waiting_room);
  RecordingSession::Options options = KA_TRY(session_options(o, call));
  KA_TRY(make_folder(call.common.out));
  // The ports of devices and the receiver of nodes have a reader of the clocks each.
  SystemClocks ports_clock, nodes_clock;
  // Only opening ports can fail with the names of devices, so the advice is set for this call
  // alone.
  console.if_it_fails(
      lab_port_advice(options.lab, sources_of(o, call), o.marks_port, o.trigger_port));
  const auto session = KA_TRY(RecordingSession::open(
      std::move(options), {call.surroundings.files, ports_clock, nodes_clock}));
  console.if_it_fails({});
  // RecordRun lives only for this line. Its destructor restores the terminal.
  const int code = RecordRun(o, call, *session)();
  // Live clients get the end of the stream after the last take is on the disk.
  session->end_live();
  take_signals();  // from here on a signal may end the program at once
  return code;
}

}  // namespace

/// The verb `kinalign record`.
Verb record_verb() {
  return make_verb<RecordJob>(
      {.name = "record",
       .summary = "devices into a recording, nothing lost",
       .text =
           "Receives, stamps and stores until Ctrl-C what devices send. The file (MCAP) is "
           "whole up to the last second at any time, whatever becomes of the program, on a disk "
           "that keeps up; no file is ever overwritten. Protocols: nodes, noitom, xsens, kinect, "
           "slimevr; transports: udp, tcp (to the device's address), tcp-listen. On a terminal "
           "keys make marks: s start, e stop, t T-pose, Enter begins and ends a text. Exit code "
           "1 where the disk failed and the recording went on in another file, or was nearly "
           "full and ended it, where a required device sent nothing, where something was sent that "
           "nobody can use, or with --wait no start came.",
       .examples =
           {{"kinalign record -o takes --device imu=nodes:5005 --device mocap=xsens:udp:9763",
             "inertial nodes, and Xsens MVN sending to this machine"},
            {"kinalign record -o takes --subject 03 --action S1A02 --device "
             "mocap=noitom:tcp:192.168.7.5:7001",
             "Axis Neuron serving; takes/03_S1A02_01.mcap. Its skeleton: lab.toml, or align's "
             "manifest"},
            {"kinalign record -o takes --config lab.toml",
             "the devices of a lab: docs/formats/lab_toml.md"},
            {"kinalign record -o takes --config lab.toml --trigger-port 30 --wait --repeat",
             "a take from each start of Vicon's to its stop, and the seconds before"},
            {"kinalign record -o takes --config lab.toml --live-port 7040",
             "and pose --live 7040 in another terminal"}},
       .common = {"out", "json"},
       .out_is_folder = true},
      describe_record, run);
}

}  // namespace kinalign
