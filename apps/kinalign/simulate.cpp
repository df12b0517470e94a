// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/console.h"
#include "apps/kinalign/json_text.h"
#include "apps/kinalign/live_rehearsal.h"
#include "apps/kinalign/simulate_folder.h"
#include "apps/kinalign/summary.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/io/bvh.h"
#include "kinalign/motion/clip_motion.h"
#include "kinalign/simulate/built_in_motion.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view built_in = "built-in";
constexpr double usual_s = 60.0, most_s = 3600.0;
constexpr std::size_t most_bvh = std::size_t{256} << 20;
// Simulated recordings begin then, so that the same seed gives the same bytes.
constexpr std::int64_t start_ns = 1'790'000'000'000'000'000;

struct Simulate {
  std::vector<std::string> motion;
  std::int64_t seed = 1;
  std::optional<double> seconds;
  std::int64_t node_rate = 100;
  std::string node_stamps = "own";
  bool live = false;
  std::string to = "127.0.0.1";
  std::int64_t mocap_port = 7012, kinect_port = 7020, node_port = 5005, marks_port = 7030;
  std::string link = "C";
  double begin_in = 0.5;
  bool clockless = false;
};

Usage describe_simulate(Simulate& o) {
  Usage usage;
  usage.positionals = {
      {"MOTION", "built-in, or a BVH of a Perception Neuron or CMU skeleton", &o.motion}};
  usage.flags = {
      {"seed", "of the person and of all that is drawn", &o.seed, 0.0, 9e15},
      {"seconds", "how long (default: 60, or all of a BVH)", &o.seconds, least_rehearsal_s, most_s},
      {"node_rate", "samples of a node, Hz: 15, 60 and 100 are usual", &o.node_rate, 1.0, 1000.0},
      {.name = "node_stamps",
       .meaning = "nodes' stamps: by their own clocks, or of arrival over the paper's radio",
       .value = &o.node_stamps,
       .choices = {"own", "arrival"}},
      {"live", "send it in real time, as the devices would", &o.live},
      {"to", "live: address of the host that records", &o.to},
      {"mocap_port", "live: the host's port for the suit", &o.mocap_port, 1.0, 65535.0},
      {"kinect_port", "live: the host's port for the Kinect", &o.kinect_port, 1.0, 65535.0},
      {"node_port", "live: the host's port for the nodes", &o.node_port, 1.0, 65535.0},
      {"marks_port", "live: the host's port for marks: the clicks on the suit's program",
       &o.marks_port, 1.0, 65535.0},
      {.name = "link",
       .meaning =
           "live: the nodes' radio (docs/clock.md: A wired, B quiet Wi-Fi, C the paper's ...)",
       .value = &o.link,
       .choices = {"A", "B", "C", "D", "E", "F", "G"}},
      {"begin_in", "live: time to start the recorder in, s", &o.begin_in, 0.1, 3600.0},
      {"clockless", "live: nodes without a counter, as the paper's; --node-rate 15 is theirs",
       &o.clockless}};
  usage.check = [&o](const Common& common, const Sources& given) -> Result<void> {
    if (common.out.empty()) return Failure(Error{"--out", 0, "a new folder's name", "none"});
    const auto refuse = [&](const char* name, const char* flag, const char* wanted,
                            const char* found) {
      return given.contains(name) ? Result<void>(Failure(Error{flag, 0, wanted, found}))
                                  : Result<void>{};
    };
    if (o.live) {
      return refuse("node_stamps", "--node-stamps", "files", "--live, where nodes send their own");
    }
    for (const auto& [name, flag] :
         {std::pair("to", "--to"), std::pair("link", "--link"), std::pair("begin_in", "--begin-in"),
          std::pair("clockless", "--clockless"), std::pair("mocap_port", "--mocap-port"),
          std::pair("kinect_port", "--kinect-port"), std::pair("node_port", "--node-port"),
          std::pair("marks_port", "--marks-port")}) {
      KA_TRY(refuse(name, flag, "--live beside it", "none"));
    }
    return {};
  };
  return usage;
}

Result<Motion> motion_of(const Simulate& o, FileSystem& files) {
  const std::string& name = o.motion.front();
  if (name == built_in) {
    return built_in_motion(
        {.length_s = o.seconds.value_or(usual_s), .seed = static_cast<std::uint64_t>(o.seed)});
  }
  BvhFile file = KA_TRY(read_bvh(KA_TRY(read_whole(files, name, most_bvh)), name, {}));
  auto motion = kinalign::motion_of(file.clip);
  if (!motion) return Failure(Error{name, 0, motion.error().expected, motion.error().found});
  motion->length_s = std::min(motion->length_s, o.seconds.value_or(most_s));
  return motion;
}

Json json_of(const TrueRecording& truth, const Rehearsal& rehearsal, const std::string& folder) {
  std::uint64_t samples = 0;
  for (const SimulatedNode& node : rehearsal.nodes) samples += node.samples.size();
  return {{"folder", folder},
          {"truth", folder + "/truth/truth.json"},
          {"seed", truth.seed},
          {"length_s", truth.length_s},
          {"mocap_frames", truth.mocap.frames},
          {"kinect_frames", rehearsal.ticks.size()},
          {"node_samples", samples}};
}

std::string head_line(const TrueRecording& truth, const std::string& folder) {
  return fmt::format("{}: {} of {}, seed {}\n", folder, duration_text(truth.length_s), truth.motion,
                     truth.seed);
}

/// What was made, in lines and as JSON.
void tell_files(const TrueRecording& truth, const Rehearsal& rehearsal, Call& call) {
  const std::string& folder = call.common.out;
  Json json = json_of(truth, rehearsal, folder);
  std::string text = head_line(truth, folder);
  text += fmt::format("  mocap   {} frames at {} Hz: mocap.bvh\n", grouped(truth.mocap.frames),
                      truth.mocap.rate_hz);
  text += fmt::format("  kinect  {} frames: kinect.csv\n", grouped(rehearsal.ticks.size()));
  text += fmt::format("  imu     {} samples of {} nodes: imu_*.csv\n",
                      grouped(json["node_samples"].get<std::uint64_t>()), rehearsal.nodes.size());
  text += "  truth   truth/truth.json, truth/motion.bvh\n";
  text += fmt::format("  next    kinalign align {0}/recording.toml -o {0}/take.h5\n", folder);
  call.console.print(harmless(text));
  json["manifest"] = folder + "/recording.toml";
  call.console.print_json(json_text(json));
}

void tell_start(const TrueRecording& truth, const Rehearsal& rehearsal, const Simulate& o,
                Call& call) {
  const std::string& folder = call.common.out;
  call.console.print(
      harmless(head_line(truth, folder) +
               fmt::format("  sending to {}: mocap on port {}, kinect {}, imu {}, marks {}\n", o.to,
                           o.mocap_port, o.kinect_port, o.node_port, o.marks_port) +
               fmt::format("  record  kinalign record -o {0} --config {0}/lab.toml\n", folder)));
  Json json{{"event", "sending"}};
  json.update(json_of(truth, rehearsal, folder));
  json["start_raw_ns"] = truth.host->raw_ns;
  json["start_utc_ns"] = truth.host->utc_ns;
  call.console.print_json(json_text(json));
  call.console.flush();
}

void tell_end(const LiveCounts& counts, const std::string& folder, Call& call) {
  const double late_ms = 1e3 * seconds(counts.worst_late);
  std::string text =
      fmt::format("  sent {} frames of mocap, {} of kinect, {} of nodes with {} samples\n",
                  grouped(counts.mocap_frames), grouped(counts.kinect_frames),
                  grouped(counts.node_frames), grouped(counts.node_samples));
  text += fmt::format("  {} replies reached nodes; a frame left {:.1f} ms late at the worst\n",
                      grouped(counts.replies), late_ms);
  if (counts.refused > 0) {
    text += fmt::format("  {} datagrams were not taken: nobody listens there\n",
                        grouped(counts.refused));
  }
  const bool heard = counts.replies > 0 || counts.refused == 0;
  text += heard
              ? fmt::format("  next    kinalign align {0}/recording.toml -o {0}/take.h5\n", folder)
              : "  nobody received this: start kinalign record first (--begin-in gives it time)\n";
  call.console.print(harmless(text));
  call.console.print_json(json_text(Json{{"event", "sent"},
                                         {"mocap_frames", counts.mocap_frames},
                                         {"kinect_frames", counts.kinect_frames},
                                         {"node_frames", counts.node_frames},
                                         {"node_samples", counts.node_samples},
                                         {"replies", counts.replies},
                                         {"refused", counts.refused},
                                         {"worst_late_ms", late_ms}}));
}

/// Says of a truth what only the verb knows.
TrueRecording named(TrueRecording truth, const Simulate& o) {
  truth.seed = static_cast<std::uint64_t>(o.seed);
  truth.motion = o.motion.front() == built_in ? built_in : file_name(o.motion.front());
  truth.motion_file = "motion.bvh";
  return truth;
}

Result<int> write_files(const Simulate& o, const RehearsalFolder& folder, const Motion& motion,
                        const Rehearsal& rehearsal, Call& call) {
  TrueRecording truth = named(truth_of(rehearsal, motion, utc_time(start_ns)), o);
  const NodeStamps stamps = o.node_stamps == "own" ? NodeStamps::own : NodeStamps::arrival;
  KA_TRY(write_devices(folder, rehearsal, motion, stamps, truth));
  KA_TRY(write_truth(folder, truth));
  call.console.if_it_fails({});
  tell_files(truth, rehearsal, call);
  return 0;
}

Result<int> send_live(const Simulate& o, const RehearsalFolder& folder, const Motion& motion,
                      const Rehearsal& rehearsal, Call& call) {
  KA_TRY(write_suit_head(folder, motion));
  SystemClocks clock;
  const LiveOptions options{.to = o.to,
                            .mocap_port = static_cast<std::uint16_t>(o.mocap_port),
                            .kinect_port = static_cast<std::uint16_t>(o.kinect_port),
                            .node_port = static_cast<std::uint16_t>(o.node_port),
                            .marks_port = static_cast<std::uint16_t>(o.marks_port),
                            .link = static_cast<Link>(o.link.front() - 'A'),
                            .seed = static_cast<std::uint64_t>(o.seed),
                            .begin_in_s = o.begin_in,
                            .clockless = o.clockless};
  KA_TRY(write_lab(folder, options, rehearsal));
  std::optional<double> clockless_hz;
  if (o.clockless) clockless_hz = static_cast<double>(o.node_rate);
  KA_TRY(write_live_manifest(folder, rehearsal, clockless_hz));
  take_signals();
  LiveRehearsal live = KA_TRY(LiveRehearsal::open(motion, rehearsal, options, clock));
  TrueRecording truth = named(live_truth(rehearsal, motion, live.start(), clockless_hz), o);
  truth.link = o.link;
  KA_TRY(write_truth(folder, truth));
  call.console.if_it_fails({});
  tell_start(truth, rehearsal, o, call);
  live.run([&](double) { return !interrupted(); });
  tell_end(live.counts(), folder.path, call);
  return 0;
}

Result<int> run(Simulate& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const Motion motion = KA_TRY(motion_of(o, files));
  auto rehearsal = rehearse(motion, {.seed = static_cast<std::uint64_t>(o.seed),
                                     .node_rate_hz = static_cast<std::uint32_t>(o.node_rate)});
  if (!rehearsal) {
    return Failure(Error{o.motion.front(), 0, rehearsal.error().expected, rehearsal.error().found});
  }
  const RehearsalFolder folder{files, call.common.out};
  KA_TRY(make_new_folder(folder.path));
  call.console.if_it_fails([path = folder.path](const Error&) {
    return std::vector<std::string>{path + " is not whole: delete it"};
  });
  KA_TRY(make_new_folder(folder.path + "/truth"));
  KA_TRY(write_motion(folder, motion));
  return o.live ? send_live(o, folder, motion, *rehearsal, call)
                : write_files(o, folder, motion, *rehearsal, call);
}

}  // namespace

Verb simulate_verb() {
  return make_verb<Simulate>(
      {.name = "simulate",
       .summary = "what devices would have recorded of a motion, with the truth",
       .text = "Writes into a new folder what a suit (60 Hz, started and stopped by clicks), a "
               "Kinect v2 (30 Hz) and five inertial nodes would have recorded, each by its own "
               "clock and with its own errors; recording.toml for align; and in truth/ what no "
               "device knows. The same seed gives the same bytes. With --live it sends them in "
               "real time instead: Noitom's stream, the Kinect sender's, and five nodes over a "
               "radio that delays and loses.",
       .examples = {{"kinalign simulate built-in -o rehearsal --seconds 60",
                     "a person of our own making, then: kinalign align rehearsal/recording.toml -o "
                     "take.h5"},
                    {"kinalign simulate walk.bvh -o rehearsal --seed 7 --node-rate 15",
                     "your own motion, with nodes as slow as the paper's"},
                    {"kinalign simulate built-in -o rehearsal --live --seconds 20",
                     "to kinalign record -o rehearsal --config rehearsal/lab.toml"}},
       .common = {"out", "json"},
       .out_is_folder = true,
       .out_is_new = true},
      describe_simulate, run);
}

}  // namespace kinalign
