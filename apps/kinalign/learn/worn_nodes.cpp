// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/worn_nodes.h"

#include "apps/kinalign/text/describe_file.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr double longest_lost_s = 2.0;  // a node that is lost longer is told

/// "START,END" in seconds; absent where the text is empty.
Result<std::optional<TPoseSeconds>> t_pose_seconds(const std::string& text) {
  if (text.empty()) return std::optional<TPoseSeconds>();
  const std::size_t comma = text.find(',');
  TPoseSeconds out;
  if (comma != std::string::npos && parse_number(text.substr(0, comma), out.from) &&
      parse_number(text.substr(comma + 1), out.to) && out.from >= 0.0 && out.to > out.from) {
    return std::optional(out);
  }
  return Failure(Error{"--tpose", 0, "START,END in seconds, such as 1.5,4", shown(text)});
}

Result<ChosenTPose> choose_t_pose(const std::string& wanted, const WornFrames& worn,
                                  double rate_hz) {
  ChosenTPose out;
  if (const auto seconds = KA_TRY(t_pose_seconds(wanted))) {
    const double frames = static_cast<double>(worn.frames());
    out.frames.first =
        static_cast<std::size_t>(std::min(std::ceil(seconds->from * rate_hz), frames));
    const auto end =
        static_cast<std::size_t>(std::min(std::floor(seconds->to * rate_hz) + 1.0, frames));
    if (end <= out.frames.first) {
      return Failure(Error{"--tpose", 0,
                           fmt::format("seconds within 0 to {:.1f}", frames / rate_hz),
                           shown(wanted)});
    }
    out.frames.count = end - out.frames.first;
  } else {
    const auto still = first_still(worn, rate_hz);
    if (!still) {
      return Failure(Error{"", 0,
                           "a second in which no node turns faster than 20 deg/s, for the T-pose",
                           "none (--tpose START,END names one)"});
    }
    out.frames = *still;
    out.found = true;
  }
  out.from_s = static_cast<double>(out.frames.first) / rate_hz;
  out.to_s = static_cast<double>(out.frames.first + out.frames.count) / rate_hz;
  return out;
}

/// The share of frames in which a node is valid, and its longest loss, s.
struct NodePresence {
  double valid = 0.0, longest_lost_s = 0.0;
};

NodePresence presence_of(const NodeFrames& nodes, std::size_t node, double rate_hz) {
  std::size_t run = 0, longest = 0, valid = 0;
  for (std::size_t t = 0; t < nodes.frames(); ++t) {
    const bool is_valid = nodes.valid[t * nodes.nodes + node] != 0;
    run = is_valid ? 0 : run + 1;
    longest = std::max(longest, run);
    valid += is_valid ? 1 : 0;
  }
  return {static_cast<double>(valid) / static_cast<double>(nodes.frames()),
          static_cast<double>(longest) / rate_hz};
}

/// Of a node: its warning, if there is one.
std::string warning_of(const PosedNodes& posed, const PoseLayout& layout, std::size_t node,
                       const NodePresence& presence) {
  const std::string& name = layout.nodes[node];
  const auto& worn = posed.calibration.nodes[node];
  if (presence.valid == 0.0) return name + " has no samples: its limb is a guess";
  if (!worn) return name + " has no samples in the T-pose, and is left out: its limb is a guess";
  if (presence.longest_lost_s >= longest_lost_s) {
    return fmt::format("{} is missing for {:.1f} s: there its limb is a guess", name,
                       presence.longest_lost_s);
  }
  const bool is_checked =
      posed.calibration.worn_as_told || posed.calibration.headings == Headings::mounting;
  if (!is_checked || worn->tilt_deg <= most_tilt_deg) return "";
  if (worn_place(name)->on_arm) {
    return fmt::format("{} is held {:.0f} deg off a T-pose: arms hung, or it is worn another way",
                       name, worn->tilt_deg);
  }
  return fmt::format("{} is worn {:.0f} deg off what docs/pose.md says", name, worn->tilt_deg);
}

std::string heading_line(const Json& about) {
  if (about.at("headings") == "mounting") return "each node's own, by how it is worn";
  return about.at("facing") == "arms" ? "one for all nodes, by arms that come down"
                                      : "one for all nodes, by how they are worn";
}

std::string t_pose_line(const Json& about) {
  const Json& t_pose = about.at("t_pose");
  std::string out = fmt::format("{:.1f} to {:.1f} s{}, no node turned faster than {:.0f} deg/s",
                                t_pose.at("from_s").get<double>(), t_pose.at("to_s").get<double>(),
                                t_pose.at("found").get<bool>() ? ", the first still stretch" : "",
                                t_pose.at("fastest_deg_s").get<double>());
  std::string arms;
  for (const auto& [name, node] : about.at("nodes").items()) {
    const WornPlace* place = worn_place(name);
    if (place == nullptr || !place->on_arm || node.at("tilt_deg").is_null()) continue;
    arms += fmt::format("{}{:.0f}", arms.empty() ? "" : " and ", node.at("tilt_deg").get<double>());
  }
  const bool is_checked =
      about.at("worn_as_told").get<bool>() || about.at("headings") == "mounting";
  if (!is_checked) return out + "; forearms not checked";
  return arms.empty() ? out : out + "; forearms " + arms + " deg off";
}

}  // namespace

std::vector<Field> worn_flags(WornWords& o) {
  return {{"tpose",
           "when the T-pose is held, s (default: the first still second)",
           &o.t_pose,
           0.0,
           0.0,
           {},
           "START,END"},
          {"heading",
           "whether nodes share a heading, or how they are worn says it",
           &o.headings,
           0.0,
           0.0,
           {"auto", "shared", "mounting"}}};
}

Result<void> check(const WornWords& o) {
  KA_TRY(t_pose_seconds(o.t_pose));
  return {};
}

Result<LiveWornOptions> live_options(const WornWords& o) {
  LiveWornOptions out;
  out.t_pose = KA_TRY(t_pose_seconds(o.t_pose));
  if (out.t_pose && out.t_pose->to > LiveWorn::most_waiting_s) {
    return Failure(Error{"--tpose", 0, "a T-pose within the first minute", shown(o.t_pose)});
  }
  if (o.headings == "shared") out.headings = Headings::shared;
  if (o.headings == "mounting") out.headings = Headings::mounting;
  return out;
}

Result<NodeChoice> choose(const PoseLayout& layout, const NamedNodes& nodes) {
  NodeChoice out;
  std::size_t leaves = 0;
  for (const std::string& wanted : layout.nodes) {
    out.push_back(node_at(nodes.names, wanted));
    if (out.back() && nodes.tracks[*out.back()].stamps.size() < 2) out.back().reset();
    if (out.back() && wanted != layout.nodes.back()) ++leaves;
  }
  if (out.back() && leaves >= 2) return out;
  std::string wanted, found;
  for (std::size_t n = 0; n < layout.leaves(); ++n)
    wanted += (n == 0 ? "" : ", ") + layout.nodes[n];
  for (std::size_t s = 0; s < nodes.names.size(); ++s) {
    if (nodes.tracks[s].stamps.size() < 2) continue;
    found += (found.empty() ? "" : ", ") + harmless(nodes.names[s]);
  }
  return Failure(Error{"", 0,
                       "a node " + layout.nodes.back() + " and two of " + wanted + " with samples",
                       found.empty() ? "none" : found, ErrorKind::no_such_node});
}

Result<PosedNodes> calibrated_nodes(const PoseLayout& layout, const Skeleton& body,
                                    NamedNodes nodes, const WornWords& o,
                                    std::optional<EvenSpan> span) {
  PosedNodes out;
  out.choice = KA_TRY(choose(layout, nodes));
  const NodeChoice& choice = out.choice;
  std::vector<NodeTrack> tracks(layout.nodes.size());
  CalibrationOptions options;
  for (std::size_t n = 0; n < choice.size(); ++n) {
    options.worn.emplace_back();
    if (!choice[n]) continue;
    tracks[n] = std::move(nodes.tracks[*choice[n]]);
    options.worn.back() = nodes.worn[*choice[n]];
    KA_TRY(complete(tracks[n]));
  }
  out.even = KA_TRY(even_nodes(tracks, layout.rate_hz, span));
  out.t_pose = KA_TRY(choose_t_pose(o.t_pose, out.even.worn, layout.rate_hz));
  options.t_pose = out.t_pose.frames;
  if (o.headings == "shared") options.headings = Headings::shared;
  if (o.headings == "mounting") options.headings = Headings::mounting;
  out.calibration = KA_TRY(calibrate(layout, body, out.even.worn, options));
  return out;
}

Json about_nodes(const PoseLayout& layout, const PosedNodes& posed, const NodeFrames& nodes,
                 const NamedNodes& named) {
  const NodeChoice& choice = posed.choice;
  Json each = Json::object(), warnings = Json::array();
  double valid = 0.0;
  const double fastest = fastest_turn_deg(posed.even.worn, posed.t_pose.frames);
  if (fastest > most_turn_deg_s) {
    warnings.push_back(
        fmt::format("in the T-pose a node turned at {:.0f} deg/s: it was not held still", fastest));
  }
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
    const NodePresence presence = presence_of(nodes, n, layout.rate_hz);
    const auto& worn = posed.calibration.nodes[n];
    each[layout.nodes[n]] = {{"called", choice[n] ? Json(named.names[*choice[n]]) : Json()},
                             {"valid", presence.valid},
                             {"tilt_deg", worn ? Json(worn->tilt_deg) : Json()}};
    valid += presence.valid / static_cast<double>(layout.nodes.size());
    const std::string warning = warning_of(posed, layout, n, presence);
    if (!warning.empty()) warnings.push_back(warning);
  }
  const NodeCalibration& calibration = posed.calibration;
  return {{"valid", valid},
          {"nodes", std::move(each)},
          {"t_pose",
           {{"from_s", posed.t_pose.from_s},
            {"to_s", posed.t_pose.to_s},
            {"found", posed.t_pose.found},
            {"fastest_deg_s", fastest}}},
          {"headings", calibration.headings == Headings::shared ? "shared" : "mounting"},
          {"facing", calibration.facing == Facing::arms ? "arms" : "mounting"},
          {"spread_deg", calibration.spread_deg},
          {"worn_as_told", calibration.worn_as_told},
          {"warnings", std::move(warnings)}};
}

std::string node_lines(const Json& about) {
  std::size_t there = 0;
  for (const auto& [name, node] : about.at("nodes").items()) {
    if (node.at("valid").get<double>() > 0.0) ++there;
  }
  return fmt::format("nodes    {} of {}, {:.1f} % valid\nT-pose   {}\nheading  {}\n", there,
                     about.at("nodes").size(), 100.0 * about.at("valid").get<double>(),
                     t_pose_line(about), heading_line(about));
}

}  // namespace kinalign
