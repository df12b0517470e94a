// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command_line.h"
#include "apps/cli/field_text.h"
#include "apps/cli/program.h"
#include "apps/kinalign/simulate/simulate_folder.h"
#include "apps/kinalign/simulate/simulate_text.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/motion/interpolation/clip_motion.h"
#include "kinalign/simulate/person/built_in_motion.h"

#include <fcntl.h>

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace kinalign {

namespace {

constexpr std::string_view built_in = "built-in";
// The default and the largest length of a rehearsal, s, and the largest size of a BVH file, bytes.
constexpr double usual_s = 60.0, most_s = 3600.0;
constexpr std::size_t most_bvh = std::size_t{256} << 20;
// Simulated recordings always begin at this time, so that the same seed gives the same bytes.
constexpr std::int64_t start_ns = 1'790'000'000'000'000'000;

/// The options of `kinalign simulate`.
struct Simulate {
  std::vector<std::string> motion;
  std::int64_t seed = 1;
  std::optional<double> seconds;
  std::int64_t node_rate = 100;
  std::string node_stamps = "own";
  bool live = false;
  // These two are for --live only. run() copies the link and the seed into `sending`.
  std::string link = "C";
  LiveOptions sending;
};

/// Refuses the same port for two devices, because a recorder opens one port for each device.
Result<void> check_live_ports(const LiveOptions& o) {
  std::map<std::int64_t, const char*> flags;
  for (const auto& [port, flag] :
       {std::pair(o.mocap_port, "--mocap-port"), std::pair(o.kinect_port, "--kinect-port"),
        std::pair(o.node_port, "--node-port"), std::pair(o.marks_port, "--marks-port")}) {
    const auto [other, is_free] = flags.emplace(port, flag);
    if (is_free) continue;
    return Failure(Error{flag, 0, std::string("a port other than that of ") + other->second,
                         std::to_string(port)});
  }
  return {};
}

/// Checks flags that exclude or need each other; most of them need --live.
Result<void> check_simulate(const Simulate& o, const Common& common, const Sources& given) {
  if (common.out.empty()) return Failure(Error{"--out", 0, "a new folder's name", "none"});
  if (o.live) {
    KA_TRY(check_live_address(o.sending.to));
    // Only a live run uses ports.
    KA_TRY(check_live_ports(o.sending));
    if (!given.contains("node_stamps")) return {};
    return Failure(
        Error{"--node-stamps", 0, "files", "--live, with which the nodes send their own stamps"});
  }
  for (const char* name : {"to", "link", "begin_in", "clockless", "mocap_port", "kinect_port",
                           "node_port", "marks_port"}) {
    if (given.contains(name))
      return Failure(Error{flag_of(name), 0, "--live as well", "no --live"});
  }
  return {};
}

/// The command line of `kinalign simulate`.
Usage describe_simulate(Simulate& o) {
  Usage usage;
  usage.positionals = {{"MOTION",
                        "built-in, or a BVH of a Perception Neuron or CMU skeleton, 3 s at least",
                        &o.motion}};
  usage.flags = {
      {"seed", "seed of all random numbers", &o.seed, 0.0, 9e15},
      {"seconds", "length, s (default: 60, or the whole BVH, which is also the longest)",
       &o.seconds, least_rehearsal_s, most_s},
      {"node_rate", "samples of a node, Hz: 15, 60 and 100 are usual", &o.node_rate, 1.0, 1000.0},
      {.name = "node_stamps",
       .meaning = "nodes' stamps: by their own clocks, or times of arrival over the paper's radio",
       .value = &o.node_stamps,
       .choices = {"own", "arrival"}},
      {"live",
       "send the streams in real time, as the devices would; a BVH must have a suit's 59 joints",
       &o.live},
      {"to", "live: address of the host that records, in numbers", &o.sending.to},
      {"mocap_port", "live: the host's port for the suit", &o.sending.mocap_port, 1.0, 65535.0},
      {"kinect_port", "live: the host's port for the Kinect", &o.sending.kinect_port, 1.0, 65535.0},
      {"node_port", "live: the host's port for the nodes", &o.sending.node_port, 1.0, 65535.0},
      {"marks_port", "live: the host's port for marks: the clicks on the suit's program",
       &o.sending.marks_port, 1.0, 65535.0},
      {.name = "link",
       .meaning = "live: the nodes' radio (docs/simulated_links.md: A wired, B quiet Wi-Fi, C the "
                  "paper's ...)",
       .value = &o.link,
       .choices = {"A", "B", "C", "D", "E", "F", "G"}},
      {"begin_in", "live: wait before sending, to start the recorder, s", &o.sending.begin_in_s,
       0.1, 3600.0},
      {"clockless", "live: nodes without a counter, like the paper's, which have --node-rate 15",
       &o.sending.clockless}};
  usage.check = [&o](const Common& common, const Sources& given) {
    return check_simulate(o, common, given);
  };
  return usage;
}

/// The built-in motion or the motion of a BVH file. --seconds may shorten it.
Result<Motion> motion_of(const Simulate& o, Call& call) {
  const std::string& name = o.motion.front();
  if (name == built_in) {
    return built_in_motion(
        {.length_s = o.seconds.value_or(usual_s), .seed = static_cast<std::uint64_t>(o.seed)});
  }
  // A typing error in "built-in" would be reported as a missing file, so the advice suggests the
  // right word.
  call.console.if_it_fails([near = suggestion(name, {std::string(built_in)})](const Error&) {
    return near.empty() ? std::vector<std::string>{} : std::vector<std::string>{near};
  });
  const std::string text = KA_TRY(read_whole(call.surroundings.files, name, most_bvh));
  // The file exists, so the suggestion must not appear below errors in its content.
  call.console.if_it_fails({});
  const BvhFile file = KA_TRY(read_bvh(text, name, {}));
  auto motion = kinalign::motion_of(file.clip);
  if (!motion) return Failure(Error{name, 0, motion.error().expected, motion.error().found});
  motion->length_s = std::min(motion->length_s, o.seconds.value_or(most_s));
  return motion;
}

/// Adds to the truth what only this verb knows: the seed and the names of the motion.
TrueRecording named(TrueRecording truth, const Simulate& o) {
  truth.seed = static_cast<std::uint64_t>(o.seed);
  // The truth has the file's name without its folder, so that it does not depend on where the file
  // is.
  truth.motion = o.motion.front() == built_in ? built_in : file_name(o.motion.front());
  truth.motion_file = "motion.bvh";
  return truth;
}

/// Everything that is needed to write or send a rehearsal.
struct Job {
  const Simulate& o;
  RehearsalFolder folder;
  const Motion& motion;
  const Rehearsal& rehearsal;
};

/// Writes the files of all devices, the manifest and the truth.
Result<int> write_files(const Job& job, Call& call) {
  const Simulate& o = job.o;
  TrueRecording truth = named(truth_of(job.rehearsal, job.motion, utc_time(start_ns)), o);
  const NodeStamps stamps = o.node_stamps == "own" ? NodeStamps::own : NodeStamps::arrival;
  KA_TRY(write_devices(job.folder, job.rehearsal, job.motion, {.stamps = stamps}, truth));
  KA_TRY(write_truth(job.folder, truth));
  // The folder is complete here, so the advice to delete it is removed.
  call.console.if_it_fails({});
  print_files({truth, job.rehearsal, job.folder.path, o.seconds}, call.console);
  return done;
}

bool is_there(FileSystem& files, const std::string& path) {
  const int fd = files.open(path.c_str(), O_RDONLY | O_CLOEXEC, 0);
  if (fd >= 0) files.close(fd);
  return fd >= 0;
}

/// Sends a rehearsal live. The recorder's files and the truth are written first, so that the user
/// can start a recorder before the sending begins.
Result<int> send_live(const Job& job, LiveSockets sockets, Call& call) {
  const Simulate& o = job.o;
  const LiveOptions& options = o.sending;
  KA_TRY(write_suit_head(job.folder, job.motion));
  KA_TRY(write_lab(job.folder, options, job.rehearsal));
  std::optional<double> clockless_hz;
  if (options.clockless) clockless_hz = static_cast<double>(o.node_rate);
  // Nodes without a counter send no stamps, so `align` needs their rate from the manifest.
  KA_TRY(write_live_manifest(job.folder, job.rehearsal, clockless_hz));
  SystemClocks clock;
  LiveRehearsal live(job.motion, job.rehearsal, options, clock, std::move(sockets));
  TrueRecording truth = named(live_truth(job.rehearsal, job.motion, live.start(), clockless_hz), o);
  truth.link = o.link;
  // The truth depends only on the start, so it is written before the first datagram is sent.
  KA_TRY(write_truth(job.folder, truth));
  call.console.if_it_fails({});
  print_start({truth, job.rehearsal, job.folder.path, o.seconds}, options, call.console);
  SentRehearsal sent{.options = options, .folder = job.folder.path};
  sent.length_s = job.motion.length_s;
  sent.sent_s = live.run([] { return !interrupted(); });
  sent.counts = live.counts();
  // If the recorder wrote into this folder, the text names the next step.
  sent.recorded_there = is_there(job.folder.files, job.folder.path + "/" + live_take_name);
  print_end(sent, call.console);
  // The exit code is `stopped` after Ctrl-C, 1 if no program answered, else 0.
  if (!sent.whole()) return stopped;
  return sent.unanswered() ? findings : done;
}

/// The motion and the route to the host are checked before a folder is made.
Result<int> run(Simulate& o, Call& call) {
  // The letters A to G name the values of Link in their order.
  o.sending.link = static_cast<Link>(o.link.front() - 'A');
  o.sending.seed = static_cast<std::uint64_t>(o.seed);
  const std::string& name = o.motion.front();
  const Motion motion = KA_TRY(motion_of(o, call));
  call.console.if_it_fails([](const Error&) {
    // This advice is only for errors of check_live(), since files may have other skeletons than the
    // live stream.
    return std::vector<std::string>{"without --live the motion can be simulated into files"};
  });
  if (o.live) KA_TRY(check_live(motion, name));
  call.console.if_it_fails({});
  auto rehearsal = rehearse(motion, {.seed = static_cast<std::uint64_t>(o.seed),
                                     .node_rate_hz = static_cast<std::uint32_t>(o.node_rate)});
  if (!rehearsal) {
    return Failure(Error{name, 0, rehearsal.error().expected, rehearsal.error().found});
  }
  call.console.if_it_fails([to = o.sending.to](const Error&) {
    return std::vector<std::string>{"nothing was written",
                                    "ip route get " + to + " shows this machine's route to it"};
  });
  std::optional<LiveSockets> sockets;
  // The sockets are opened before the folder is made, so that an error leaves no folder.
  if (o.live) sockets = KA_TRY(open_live(o.sending, rehearsal->nodes.size()));
  call.console.if_it_fails({});
  const RehearsalFolder folder{call.surroundings.files, call.common.out};
  // An existing folder is refused, so that files of two simulations are never mixed.
  KA_TRY(make_new_folder(folder.path));
  // After a failure below, the folder has only some of its files.
  call.console.if_it_fails([path = folder.path](const Error&) {
    return std::vector<std::string>{path + " is incomplete: delete it"};
  });
  KA_TRY(make_new_folder(folder.path + "/truth"));
  // The motion is part of the truth, for files and for live runs.
  KA_TRY(write_motion(folder, motion));
  const Job job{o, folder, motion, *rehearsal};
  return sockets ? send_live(job, *std::move(sockets), call) : write_files(job, call);
}

}  // namespace

/// The verb `kinalign simulate`.
Verb simulate_verb() {
  return make_verb<Simulate>(
      {.name = "simulate",
       .summary = "simulate what devices record of a motion, with the truth",
       .text = "Writes into a new folder what a suit (60 Hz, started and stopped by clicks), a "
               "Kinect v2 (30 Hz) and five inertial nodes would have recorded, each by its own "
               "clock and with its own errors. The folder also has recording.toml for align, and "
               "the true motion and clocks in truth/. The same seed gives the same bytes. --live "
               "sends the streams in real time instead: Noitom's stream, the Kinect sender's, and "
               "five nodes over a radio with delays and losses.",
       .examples = {{"kinalign simulate built-in -o rehearsal --seconds 60",
                     "a built-in motion; then: kinalign align rehearsal/recording.toml -o take.h5"},
                    {"kinalign simulate walk.bvh -o rehearsal --seed 7 --node-rate 15",
                     "your own motion, with nodes at the paper's rate"},
                    {"kinalign simulate built-in -o rehearsal --live --seconds 20",
                     "to kinalign record -o rehearsal --config rehearsal/lab.toml"}},
       .common = {"out", "json"},
       .out_is_folder = true,
       .out_is_new = true},
      describe_simulate, run);
}

}  // namespace kinalign
