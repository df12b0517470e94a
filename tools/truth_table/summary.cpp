// SPDX-License-Identifier: Apache-2.0
#include "tools/truth_table/summary.h"

#include "apps/kinalign/text/summary.h"

#include "kinalign/simulate/person/programme.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>
#include <utility>

namespace kinalign {

namespace {

/// The activity in each piece of a programme, in the order of Piece.
constexpr std::array<std::string_view, piece_names.size()> doings{"holds a T-pose",
                                                                  "stands",
                                                                  "steps",
                                                                  "walks",
                                                                  "walks about",
                                                                  "waves",
                                                                  "bends",
                                                                  "turns",
                                                                  "squats",
                                                                  "raises both arms in front",
                                                                  "raises both arms to the sides",
                                                                  "pushes with one hand",
                                                                  "pushes with both hands",
                                                                  "bends to the side",
                                                                  "twists",
                                                                  "squats deeply"};

/// "a, b and c"
std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
    text += parts[i];
  }
  return text;
}

std::string milliseconds(double s) { return fmt::format("{:.{}f} ms", 1e3 * s, s < 1e-3 ? 2 : 1); }

/// "a person who holds a T-pose, waves and walks", or the name of a motion that was read.
std::string motion_text(const TrueRecording& truth) {
  if (truth.motion != "built-in") return truth.motion;
  std::vector<std::string> doing;
  for (const ProgrammePiece& one : default_programme(truth.length_s, truth.seed)) {
    const std::string word(doings[static_cast<std::size_t>(one.piece)]);
    if (std::find(doing.begin(), doing.end(), word) == doing.end()) doing.push_back(word);
  }
  return "a person who " + listed(doing);
}

/// The time errors of all devices of one stream together.
struct StreamTimes {
  std::size_t devices = 0;
  std::uint64_t samples = 0, certified = 0, outside = 0;
  double median_s = 0.0, worst_s = 0.0;  // s, of the device with the largest error
  double half_width_s = 0.0;
};

StreamTimes times_of(const JudgedRecording& judged, const std::string& stream) {
  StreamTimes all;
  for (const TimeJudgement& one : judged.times) {
    if (one.stream != stream) continue;
    ++all.devices;
    all.samples += one.samples;
    all.certified += one.certified;
    all.outside += one.outside;
    all.median_s = std::max(all.median_s, one.median_s);
    all.worst_s = std::max(all.worst_s, one.worst_s);
    all.half_width_s = std::max(all.half_width_s, one.half_width_s.value_or(0.0));
  }
  return all;
}

/// "nodes ± 4.8 ms guaranteed, 0.26 ms at most in fact", or the errors of stamps without an
/// interval.
std::string time_text(const StreamTimes& all, std::string_view name, bool live) {
  if (all.certified > 0) {
    const std::string in_fact =
        all.outside == 0
            ? fmt::format("{} at most in fact", milliseconds(all.worst_s))
            : fmt::format("WRONG for {} of {} samples, the worst {} off", grouped(all.outside),
                          grouped(all.certified), milliseconds(all.worst_s));
    return fmt::format("{} ± {} guaranteed, {}", name, milliseconds(all.half_width_s), in_fact);
  }
  return fmt::format("{} {} {}", name, milliseconds(all.median_s),
                     live ? "late (the least its sender takes)" : "off");
}

const ValueJudgement* value_of(const JudgedRecording& judged, const std::string& stream,
                               const std::string& node) {
  const auto found = std::find_if(
      judged.values.begin(), judged.values.end(),
      [&](const ValueJudgement& one) { return one.stream == stream && one.node == node; });
  return found == judged.values.end() ? nullptr : &*found;
}

std::string centimetres(double m) { return fmt::format("{:.1f} cm", 100.0 * m); }

std::string degrees(double rad) { return fmt::format("{:.2f}°/s", rad * 180.0 / std::numbers::pi); }

/// The streams of the truth that are in the recording.
struct Devices {
  StreamTimes suit, kinect, nodes;
};

Devices devices_of(const JudgedRecording& judged) {
  const TrueRecording& truth = judged.truth;
  Devices devices{times_of(judged, truth.mocap.stream), times_of(judged, truth.kinect.stream), {}};
  if (!truth.nodes.empty()) devices.nodes = times_of(judged, truth.nodes.front().stream);
  return devices;
}

std::string simulated(const TrueRecording& truth, const Devices& devices) {
  std::vector<std::string> seen_by;
  if (devices.suit.devices > 0) seen_by.emplace_back("a suit");
  if (devices.kinect.devices > 0) seen_by.emplace_back("a Kinect");
  if (devices.nodes.devices > 0) seen_by.push_back(fmt::format("{} nodes", devices.nodes.devices));
  return fmt::format("{:.0f} s of {}, recorded by {}", truth.length_s, motion_text(truth),
                     listed(seen_by));
}

std::string recorded(const TrueRecording& truth, const Devices& devices) {
  std::vector<std::string> counts;
  if (devices.suit.devices > 0) counts.push_back(grouped(devices.suit.samples) + " suit frames");
  if (devices.kinect.devices > 0)
    counts.push_back(grouped(devices.kinect.samples) + " Kinect frames");
  if (devices.nodes.devices > 0) counts.push_back(grouped(devices.nodes.samples) + " node samples");
  std::string way = truth.host ? "live over loopback" : "as files";
  if (!truth.link.empty()) way += fmt::format(" and a simulated radio (link {})", truth.link);
  return way + ": " + listed(counts);
}

std::string time(const TrueRecording& truth, const Devices& devices) {
  std::vector<std::string> parts;
  const bool live = truth.host.has_value();
  if (devices.nodes.devices > 0) parts.push_back(time_text(devices.nodes, "nodes", live));
  if (devices.kinect.devices > 0) parts.push_back(time_text(devices.kinect, "Kinect", live));
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string space(const JudgedRecording& judged) {
  std::vector<std::string> parts;
  if (const auto* points = value_of(judged, judged.truth.kinect.stream, ""); points != nullptr) {
    parts.push_back(fmt::format("Kinect {} from the truth; its own noise alone is {}",
                                centimetres(points->after),
                                centimetres(points->alone.value_or(0.0))));
  }
  if (const auto* clip = value_of(judged, judged.truth.mocap.stream, ""); clip != nullptr)
    parts.push_back("suit " + centimetres(clip->after));
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string turning(const JudgedRecording& judged) {
  if (judged.truth.nodes.empty()) return "";
  const auto* all = value_of(judged, judged.truth.nodes.front().stream, "all nodes");
  if (all == nullptr) return "";
  return fmt::format("nodes {} from the truth; their own noise alone is {}", degrees(all->after),
                     degrees(all->alone.value_or(0.0)));
}

}  // namespace

std::string summary(const JudgedRecording& judged) {
  const Devices devices = devices_of(judged);
  const std::array<std::pair<std::string_view, std::string>, 5> lines{
      {{"simulated", simulated(judged.truth, devices)},
       {"recorded", recorded(judged.truth, devices)},
       {"time", time(judged.truth, devices)},
       {"space", space(judged)},
       {"turning", turning(judged)}}};
  std::string text;
  for (const auto& [head, rest] : lines) {
    if (!rest.empty()) text += fmt::format("{:<11}{}\n", head, rest);
  }
  return text;
}

}  // namespace kinalign
