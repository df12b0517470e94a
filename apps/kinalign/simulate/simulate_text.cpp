// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/simulate/simulate_text.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/simulate/simulate_folder.h"
#include "apps/kinalign/text/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr double same_s = 0.005;  // s; texts show lengths in hundredths of a second

/// The JSON members that files and live runs share. All simulated samples are counted, even those
/// that a link loses later.
Json json_of(const RehearsalSummary& summary) {
  std::uint64_t samples = 0;
  for (const SimulatedNode& node : summary.rehearsal.nodes) samples += node.samples.size();
  return {{"folder", summary.folder},
          {"truth", summary.folder + "/truth/truth.json"},
          {"seed", summary.truth.seed},
          {"length_s", summary.truth.length_s},
          {"mocap_frames", summary.truth.mocap.frames},
          {"kinect_frames", summary.rehearsal.ticks.size()},
          {"node_samples", samples}};
}

/// The first line about a rehearsal, and a note if the motion is shorter than --seconds.
std::string head_lines(const RehearsalSummary& summary) {
  const TrueRecording& truth = summary.truth;
  std::string text = fmt::format("{}: {} of {}, seed {}\n", summary.folder,
                                 duration_text(truth.length_s), truth.motion, truth.seed);
  // The note appears only if the two lengths differ as printed.
  if (summary.asked_s && *summary.asked_s > truth.length_s + same_s) {
    text += fmt::format("  note    {} is shorter than --seconds asks for ({})\n", truth.motion,
                        duration_text(*summary.asked_s));
  }
  return text;
}

std::string align_line(const std::string& folder) {
  return fmt::format("  next    kinalign align {0}/recording.toml -o {0}/take.h5\n", folder);
}

struct Port {
  const char* name;
  std::int64_t number;
  LiveTraffic traffic;
};

std::vector<Port> ports_of(const SentRehearsal& sent) {
  const LiveOptions& options = sent.options;
  return {{"mocap", options.mocap_port, sent.counts.mocap},
          {"kinect", options.kinect_port, sent.counts.kinect},
          {"imu", options.node_port, sent.counts.nodes},
          {"marks", options.marks_port, sent.counts.clicks}};
}

/// The line about ports that refused datagrams.
std::string refused_line(const SentRehearsal& sent) {
  std::string list;
  for (const Port& port : ports_of(sent)) {
    if (port.traffic.refused == 0) continue;
    list += fmt::format("{}{} of {} on {} port {}", list.empty() ? "" : ", ",
                        grouped(port.traffic.refused), grouped(port.traffic.sent), port.name,
                        port.number);
  }
  return list.empty() ? "" : "  datagrams refused by the host: " + list + "\n";
}

/// The advice if the host sent no datagram back.
std::string no_reply_line(const SentRehearsal& sent) {
  std::string ports;
  bool taken = false;
  for (const Port& port : ports_of(sent)) {
    ports += fmt::format("{}{} {}", ports.empty() ? "" : ", ", port.name, port.number);
    // If every datagram was refused, no program listens. Otherwise a program may listen, but its
    // replies do not arrive.
    taken = taken || port.traffic.refused < port.traffic.sent;
  }
  return fmt::format(
      "  {}: is kinalign record running on ports {} of {}? --begin-in leaves time to start it\n",
      taken ? "no reply came" : "the host refused every datagram", ports, sent.options.to);
}

}  // namespace

void print_files(const RehearsalSummary& summary, Console& console) {
  Json json = json_of(summary);
  std::string text = head_lines(summary);
  text += fmt::format("  mocap   {} frames at {} Hz: mocap.bvh\n",
                      grouped(summary.truth.mocap.frames), summary.truth.mocap.rate_hz);
  text += fmt::format("  kinect  {} frames: kinect.csv\n", grouped(summary.rehearsal.ticks.size()));
  text += fmt::format("  imu     {} samples of {} nodes: imu_*.csv\n",
                      grouped(json["node_samples"].get<std::uint64_t>()),
                      summary.rehearsal.nodes.size());
  text += "  truth   truth/truth.json, truth/motion.bvh\n" + align_line(summary.folder);
  console.print(harmless(text));
  json["manifest"] = summary.folder + "/recording.toml";
  console.print_json(json_text(json));
}

void print_start(const RehearsalSummary& summary, const LiveOptions& options, Console& console) {
  console.print(harmless(
      head_lines(summary) +
      fmt::format("  sending to {}: mocap on port {}, kinect {}, imu {}, marks {}\n", options.to,
                  options.mocap_port, options.kinect_port, options.node_port, options.marks_port) +
      fmt::format("  record  kinalign record -o {0} --config {0}/lab.toml\n", summary.folder)));
  Json json{{"event", "sending"}};
  json.update(json_of(summary));
  json["start_raw_ns"] = summary.truth.host->raw_ns;
  json["start_utc_ns"] = summary.truth.host->utc_ns;
  console.print_json(json_text(json));
  // A program may wait for this line, so it must appear before the sending begins.
  console.flush();
}

SentText sent_text(const SentRehearsal& sent) {
  const LiveCounts& counts = sent.counts;
  SentText text;
  if (!sent.whole()) {
    text.sent = fmt::format("  stopped after {:.1f} s of {:.1f} s\n", sent.sent_s, sent.length_s);
  }
  text.sent += fmt::format("  sent {} frames of mocap, {} of kinect, {} of nodes with {} samples\n",
                           grouped(counts.mocap_frames), grouped(counts.kinect_frames),
                           grouped(counts.node_frames), grouped(counts.node_samples));
  text.sent += fmt::format("  {} replies reached nodes; the latest frame was sent {:.1f} ms late\n",
                           grouped(counts.replies), 1e3 * seconds(counts.worst_late));
  text.no_reply = refused_line(sent);
  // A rehearsal that was stopped early may have no answer yet, so it gets no warning. Without
  // answers the recording is empty, so no next step is named.
  const bool judged = sent.whole() || counts.all().refused > 0;
  if (sent.unanswered() && judged) text.no_reply += no_reply_line(sent);
  if (!sent.whole() || sent.unanswered()) return text;
  text.next = sent.recorded_there
                  ? align_line(sent.folder)
                  : fmt::format(
                        "  next    {0}/recording.toml names {0}/{1}, which does not exist: replace "
                        "this name by the name of your recording\n"
                        "          then: kinalign align {0}/recording.toml -o {0}/take.h5\n",
                        sent.folder, live_take_name);
  return text;
}

/// Prints the end of a live rehearsal.
void print_end(const SentRehearsal& sent, Console& console) {
  const SentText text = sent_text(sent);
  console.print(harmless(text.sent));
  if (!text.no_reply.empty()) {
    console.print(console.paint(Colour::warning, harmless(text.no_reply)));
  }
  console.print(harmless(text.next));
  const LiveCounts& counts = sent.counts;
  console.print_json(json_text(Json{{"event", "sent"},
                                    {"mocap_frames", counts.mocap_frames},
                                    {"kinect_frames", counts.kinect_frames},
                                    {"node_frames", counts.node_frames},
                                    // "replies" counts those that reached nodes through the
                                    // simulated radio; "heard" counts all datagrams that the
                                    // sockets received.
                                    {"node_samples", counts.node_samples},
                                    {"replies", counts.replies},
                                    {"datagrams", counts.all().sent},
                                    {"refused", counts.all().refused},
                                    {"heard", counts.all().received},
                                    {"worst_late_ms", 1e3 * seconds(counts.worst_late)},
                                    {"stopped", !sent.whole()},
                                    {"sent_s", sent.sent_s},
                                    {"length_s", sent.length_s}}));
}

}  // namespace kinalign
