// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/program.h"
#include "apps/kinalign/record/record_run.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <malloc.h>

#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>

namespace kinalign {

namespace {

// Bytes of memory for messages that wait for a slow disk. The memory is reserved before recording
// begins.
constexpr std::size_t waiting_room = std::size_t{16} << 20;

/// The command line of `kinalign record`, with checks that concern several flags.
Usage describe_record(RecordJob& o) {
  Usage usage;
  usage.flags = {
      {"device", "NAME=PROTOCOL[:TRANSPORT[:ADDRESS]]:PORT, as in imu=nodes:5005; may be repeated",
       &o.devices},
      {"subject", "id of the person; part of the file's name", &o.subject},
      {"action", "id of the action; part of the file's name", &o.action},
      {"seconds", "end the recording after this time, s", &o.seconds, 0.0, 1e6},
      {"wait", "wait for a start mark before the take; a stop mark ends it", &o.wait},
      {"repeat", "with --wait: then wait for the next take, until Ctrl-C", &o.repeat}};
  usage.settings = {
      {"lab_key", "file with the lab's key, from which the nodes' keys are derived", &o.lab_key},
      {"marks_port", "UDP port for marks of other programs; 0: any free one", &o.marks_port, 0.0,
       65535.0},
      {"trigger_port", "UDP port for Vicon's start and stop, usually 30", &o.trigger_port, 0.0,
       65535.0},
      {"live_port", "TCP port of this machine for pose --live and the like; 0: any free one",
       &o.live_port, 0.0, 65535.0}};
  for (const Field& field : describe(o.options)) usage.settings.push_back(field);
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    // These checks need no file. session_options() makes the checks that need lab.toml.
    if (common.out.empty()) return Failure(Error{"--out", 0, "a folder for the files", "none"});
    if (common.out.ends_with(".mcap")) {
      return Failure(Error{"--out", 0,
                           "a folder for the files; --subject and --action make their names",
                           common.out});
    }
    if (o.marks_port && o.marks_port == o.trigger_port && o.marks_port != 0) {
      return Failure(Error{"--trigger-port", 0, "another port than --marks-port",
                           std::to_string(*o.trigger_port)});
    }
    if (o.repeat && !o.wait) {
      return Failure(
          Error{"--repeat", 0, "--wait as well, because a start mark begins each take", "none"});
    }
    RecordJob flags = o;  // the ports for marks are checked later, with lab.toml
    flags.marks_port.reset();
    flags.trigger_port.reset();
    // lab_of() is called only for its errors: a wrong --device is wrong use.
    KA_TRY(lab_of(flags, {}));
    return {};
  };
  return usage;
}

/// Reserves memory at the start and keeps it. Later neither page faults nor a growing heap delay a
/// datagram on its way to the file. Must be called before other threads begin. With one arena
/// (mallopt(3)), memory that one thread frees can be used by the others.
void keep_memory(std::size_t bytes) {
  // The largest value that glibc accepts. Smaller blocks of memory come from the heap.
  constexpr int largest_mapped = 32 << 20;
  mallopt(M_ARENA_MAX, 1);
  // A threshold that is set by hand also stops glibc from adjusting it.
  mallopt(M_MMAP_THRESHOLD, largest_mapped);
  // Freed memory goes back to the system only if there is more than this.
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  // The block is freed at the end of this function, but its memory stays in the heap.
  const std::unique_ptr<void, decltype(&std::free)> room(std::malloc(bytes), &std::free);
  if (room == nullptr) return;
  std::memset(room.get(), 1, bytes);
  // Without this line the compiler may remove memset(), because its result is never read.
  asm volatile("" : : "r"(room.get()) : "memory");
}

/// Records until the user or a mark ends it. Signals do not end the program meanwhile, so that
/// Ctrl-C ends the recording properly.
Result<int> run(RecordJob& o, Call& call) {
  Console& console = call.console;
  // Before the first thread and socket: output no longer waits for readers, signals are caught, and
  // memory is reserved, in this order.
  console.never_wait();
  take_every_signal();
  keep_memory(waiting_room);
  RecordingSession::Options options = KA_TRY(session_options(o, call));
  KA_TRY(make_folders(call.common.out));
  // The ports of devices and the receiver of nodes each need their own reader of the clocks.
  SystemClocks ports_clock, nodes_clock;
  // This advice is only for errors of ports, which name a device.
  console.if_it_fails(lab_port_advice(o, options.lab, call));
  const auto session = KA_TRY(RecordingSession::open(
      std::move(options), {call.surroundings.files, ports_clock, nodes_clock}));
  console.if_it_fails({});
  // RecordRun is destroyed at the end of this line and then restores the terminal.
  const int code = RecordRun(o, call, *session)();
  // Live clients get the end of the stream after the last take is on the disk.
  session->end_live();
  take_signals();  // from here on a second signal ends the program
  return code;
}

}  // namespace

/// The verb `kinalign record`.
Verb record_verb() {
  return make_verb<RecordJob>(
      {.name = "record",
       .summary = "record what devices send",
       .text =
           "Receives, stamps and stores what devices send, until Ctrl-C. If the program or the "
           "machine stops, at most the last second is lost, if the disk is fast enough. No file is "
           "ever overwritten. The format is MCAP. Protocols: nodes, noitom, xsens, kinect, "
           "slimevr; transports: udp, tcp (to the device's address), tcp-listen. On a terminal "
           "keys make marks: s start, e stop, t T-pose, Enter begins and ends a text. Exit code "
           "1 if the disk failed and the recording continued in another file; if the disk was "
           "nearly "
           "full, which ended the take; if a required device sent nothing; if a device sent data "
           "that can't be used; or if no start mark came with --wait.",
       .examples =
           {{"kinalign record -o takes --device imu=nodes:5005 --device mocap=xsens:udp:9763",
             "inertial nodes, and Xsens MVN sending to this machine"},
            {"kinalign record -o takes --subject 03 --action S1A02 --device "
             "mocap=noitom:tcp:192.168.7.5:7001",
             "Axis Neuron; writes takes/03_S1A02_01.mcap. State the skeleton in lab.toml or in "
             "align's "
             "manifest"},
            {"kinalign record -o takes --config lab.toml",
             "the devices of a lab: docs/formats/lab_toml.md"},
            {"kinalign record -o takes --config lab.toml --trigger-port 30 --wait --repeat",
             "a take from each start of Vicon to its stop, with the seconds before the start"},
            {"kinalign record -o takes --config lab.toml --live-port 7040",
             "and pose --live 7040 in another terminal"}},
       .common = {"out", "json"},
       .out_is_folder = true},
      describe_record, run);
}

}  // namespace kinalign
