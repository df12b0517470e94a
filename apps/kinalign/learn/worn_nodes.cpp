// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/worn_nodes.h"

#include "apps/kinalign/live/live_worn_report.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr double longest_lost_s = 2.0;  // a node that is lost for longer gets a warning
// A node at rest measures only gravity, which calibration removes. If more than this remains, there
// is a warning.
constexpr double most_left_m_s2 = 3.0;  // m/s2
/// A node that repeats one sample for a longer time gets a warning.
constexpr double longest_frozen_s = 1.0;
/// A node with a larger tilt is surely not worn as docs/pose.md describes.
constexpr double sure_tilt_deg = 60.0;

/// Parses "START,END" in seconds. Empty if the text is empty.
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

/// The value of --heading. Empty if the calibration shall decide.
std::optional<Headings> headings_of(const WornWords& o) {
  if (o.headings == "shared") return Headings::shared;
  return o.headings == "mounting" ? std::optional(Headings::mounting) : std::nullopt;
}

/// The frames of the T-pose, in which the person stands still with the arms to the sides. It shows
/// how each node lies on its bone. If the user does not state the seconds, the first second in
/// which no node turns is used.
Result<ChosenTPose> choose_t_pose(const std::string& wanted, const WornFrames& worn,
                                  double rate_hz) {
  ChosenTPose out;
  if (const auto seconds = KA_TRY(t_pose_seconds(wanted))) {
    const double frames = static_cast<double>(worn.frames());
    // The ends are rounded inwards, so that all frames are within the stated seconds.
    out.frames.first =
        static_cast<std::size_t>(std::min(std::ceil(seconds->from * rate_hz), frames));
    const auto end =
        static_cast<std::size_t>(std::min(std::floor(seconds->to * rate_hz) + 1.0, frames));
    // If the seconds are after the end of the data, the error states how long the data is.
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
                           "for the T-pose, a second in which no node turns faster than 20 deg/s",
                           "no such second (--tpose START,END chooses one)"});
    }
    out.frames = *still;
    out.found = true;
  }
  return out;
}

/// The share of frames in which a node has a sample, and its longest loss, s.
struct NodePresence {
  double valid = 0.0, longest_lost_s = 0.0;
};

/// Counts the frames in which a node has a sample. The longest run of frames without one is its
/// longest loss.
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

/// The most serious warning about a node. Empty if there is none. The possible warnings are tested
/// from "no samples" to "worn in another way".
std::string warning_of(const PosedNodes& posed, const PoseLayout& layout, std::size_t node,
                       const NodePresence& presence) {
  const std::string& name = layout.nodes[node];
  const auto& worn = posed.calibration.nodes[node];
  const std::string missing =
      missing_warning(name, presence.valid > 0.0, worn.has_value(), presence.longest_lost_s);
  if (!missing.empty()) return missing;
  // If nodes are not worn as described, calibration finds their tilt, so a large tilt is no
  // mistake.
  const bool is_checked =
      posed.calibration.worn_as_described || posed.calibration.headings == Headings::mounting;
  if (!is_checked || worn->tilt_deg <= most_tilt_deg) return "";
  if (worn_place(name)->on_arm) {
    return fmt::format(
        "{} is {:.0f} deg away from a T-pose: the arms hung, or the node is worn in another "
        "orientation",
        name, worn->tilt_deg);
  }
  return fmt::format("{} is worn {:.0f} deg away from the orientation in docs/pose.md", name,
                     worn->tilt_deg);
}

/// The longest time for which a node repeats one sample, s. A broken node may send its last sample
/// again and again. Real samples never have the same digits several times.
double frozen_s(const NodeTrack& track) {
  std::int64_t longest = 0;
  std::size_t first = 0;
  const auto is_same = [&](const std::vector<double>& values, std::size_t width, std::size_t i) {
    const auto now = values.begin() + static_cast<std::ptrdiff_t>(i * width);
    return std::equal(now, now + static_cast<std::ptrdiff_t>(width),
                      now - static_cast<std::ptrdiff_t>(width));
  };
  for (std::size_t i = 1; i < track.stamps.size(); ++i) {
    // `first` is the index of the first of the present equal samples.
    if (!is_same(track.orientation, 4, i) || !is_same(track.acceleration, 3, i)) first = i;
    longest = std::max(longest, to_ns(track.stamps[i]) - to_ns(track.stamps[first]));
  }
  return 1e-9 * static_cast<double>(longest);
}

/// The time, s, at the start or end of a stream in which other nodes send and the root's node does
/// not. The root's node is the last of the tracks. The pose can't be computed without it.
double lost_with_root_s(const std::vector<NodeTrack>& tracks) {
  std::int64_t out = 0;
  const auto& root = tracks.back().stamps;
  for (const NodeTrack& track : tracks) {
    if (track.stamps.empty() || root.empty()) continue;
    out = std::max({out, to_ns(track.stamps.back()) - to_ns(root.back()),
                    to_ns(root.front()) - to_ns(track.stamps.front())});
  }
  return 1e-9 * static_cast<double>(out);
}

/// Warnings about repeated samples and about times without the root's node. The second warning is
/// given only if the frames begin and end with the root's node (`root_bounds`). Frames with a
/// Kinect go on without this node.
std::vector<std::string> sample_warnings(const PoseLayout& layout,
                                         const std::vector<NodeTrack>& tracks, bool root_bounds) {
  std::vector<std::string> out;
  for (std::size_t n = 0; n < tracks.size(); ++n) {
    if (const double frozen = frozen_s(tracks[n]); frozen > longest_frozen_s) {
      out.push_back(
          fmt::format("{} repeats one sample for {:.1f} s: during this time its limb is a guess",
                      layout.nodes[n], frozen));
    }
  }
  if (const double lost = lost_with_root_s(tracks); root_bounds && lost > longest_lost_s) {
    out.push_back(fmt::format(
        "{} sends {:.1f} s less than other nodes: without this node no pose is computed",
        layout.nodes.back(), lost));
  }
  return out;
}

/// The nodes whose acceleration at rest is not gravity: "waist: 8.8, wrist_left: 8.9".
std::string restless_nodes(const PoseLayout& layout, const NodeCalibration& calibration) {
  std::string out;
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
    const auto& worn = calibration.nodes[n];
    if (!worn || worn->zero.norm() <= most_left_m_s2) continue;
    out += fmt::format("{}{}: {:.1f}", out.empty() ? "" : ", ", layout.nodes[n], worn->zero.norm());
  }
  return out;
}

/// Warnings about nodes that were exchanged, and about headings that are not shared. `headings`:
/// the value of --heading. If two nodes were exchanged, both tilt far and the others fit. If only
/// the arms tilt, they may have hung down.
std::vector<std::string> warnings_of(const PoseLayout& layout, const NodeCalibration& calibration,
                                     const std::string& headings) {
  std::string names, tilts;
  std::size_t as_described = 0, off = 0;
  bool arms_alone = true;  // hanging arms tilt like exchanged nodes
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
    const auto& worn = calibration.nodes[n];
    if (worn && worn->tilt_deg <= most_tilt_deg) ++as_described;
    if (!worn || worn->tilt_deg <= sure_tilt_deg) continue;
    if (!worn_place(layout.nodes[n])->on_arm) arms_alone = false;
    names += (off == 0 ? "" : " and ") + layout.nodes[n];
    tilts += fmt::format("{}{:.0f}", off == 0 ? "" : " and ", worn->tilt_deg);
    ++off;
  }
  std::vector<std::string> out;
  if (const std::string restless = restless_nodes(layout, calibration); !restless.empty()) {
    out.push_back(restless +
                  " m/s2 in the T-pose are not gravity: the unit of the accelerations, gravity in "
                  "them, or the order of the quaternion's numbers is wrong");
  }
  // --heading shared or mounting states how the nodes are worn, so "auto" is needed for this
  // warning.
  if (headings == "auto" && as_described >= 2 && off >= 2 && !arms_alone) {
    out.push_back(names + " are worn " + tilts +
                  " deg away from the orientation in docs/pose.md, the others are as described "
                  "there: were these nodes swapped?");
  }
  if (headings == "shared" && calibration.worn_as_described &&
      calibration.spread_deg > most_shared_deg) {
    out.push_back(
        fmt::format("--heading shared was given, but the headings by mounting differ by {:.0f} deg "
                    "between nodes: try --heading mounting",
                    calibration.spread_deg));
  }
  return out;
}

/// The printed line about headings: they come from the mounting of each node, or all nodes share
/// one.
std::string heading_line(const Json& about) {
  if (about.at("headings") == "mounting") return "one per node, by its mounting";
  return about.at("facing") == "arms" ? "one for all nodes, by the arms coming down"
                                      : "one for all nodes, by their mounting";
}

/// The printed line about the T-pose: its seconds and the fastest turn. If tilts are checked, also
/// the tilts of the forearms, since hanging arms are the usual mistake.
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
  return arms.empty() ? out : out + "; forearms " + arms + " deg off a T-pose";
}

}  // namespace

std::vector<Field> worn_flags(WornWords& o) {
  return {text_flag("tpose", "when the T-pose is held, s (default: the first still second)",
                    &o.t_pose, "START,END"),
          choice_flag("heading",
                      "whether all nodes share a heading, or each has its own by its mounting",
                      &o.headings, {"auto", "shared", "mounting"})};
}

Result<void> check(const WornWords& o) {
  KA_TRY(t_pose_seconds(o.t_pose));
  return {};
}

Result<LiveWornOptions> live_options(const WornWords& o) {
  LiveWornOptions out;
  out.t_pose = KA_TRY(t_pose_seconds(o.t_pose));
  if (out.t_pose && out.t_pose->to > LiveWorn::most_waiting_s) {
    // A live run keeps the frames before its T-pose for one minute only.
    return Failure(Error{"--tpose", 0, "a T-pose within the first minute", shown(o.t_pose)});
  }
  out.headings = headings_of(o);
  return out;
}

/// The root's node is the last of the layout. Of the other nodes (leaves) two are enough for a
/// pose.
Result<NodeChoice> choose(const PoseLayout& layout, const NamedNodes& nodes) {
  NodeChoice out;
  std::size_t leaves = 0;
  for (const std::string& wanted : layout.nodes) {
    out.push_back(node_at(nodes.names, wanted));
    // Interpolation needs at least two samples.
    if (out.back() && nodes.tracks[*out.back()].stamps.size() < 2) out.back().reset();
    if (out.back() && wanted != layout.nodes.back()) ++leaves;
  }
  if (out.back() && leaves >= 2) return out;
  // A wrong name is the usual cause, so the error lists the wanted and the existing nodes.
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
  // Both options.worn and tracks have one element for each node of the model, even if the node is
  // absent.
  for (std::size_t n = 0; n < choice.size(); ++n) {
    options.worn.emplace_back();
    if (!choice[n]) continue;
    tracks[n] = std::move(nodes.tracks[*choice[n]]);
    options.worn.back() = nodes.worn[*choice[n]];
    // complete() computes missing quantities, such as the angular velocity from orientations.
    KA_TRY(complete(tracks[n]));
  }
  const auto warn = [&out](const std::vector<std::string>& more) {
    out.warnings.insert(out.warnings.end(), more.begin(), more.end());
  };
  warn(nodes.warnings);
  // Samples are checked before they are resampled, because repeated samples can't be recognised
  // afterwards.
  warn(sample_warnings(layout, tracks, !span));
  out.even = KA_TRY(even_nodes(tracks, layout.rate_hz, span));
  out.t_pose = KA_TRY(choose_t_pose(o.t_pose, out.even.worn, layout.rate_hz));
  options.t_pose = out.t_pose.frames;
  options.headings = headings_of(o);
  out.calibration = KA_TRY(calibrate(layout, body, out.even.worn, options));
  // The last warnings are about how the nodes are worn, which the calibration has found.
  warn(warnings_of(layout, out.calibration, o.headings));
  return out;
}

Json about_nodes(const PoseLayout& layout, const PosedNodes& posed, const NodeFrames& nodes,
                 const NamedNodes& named) {
  const NodeChoice& choice = posed.choice;
  Json each = Json::object(), warnings = Json::array();
  double valid = 0.0;
  const double fastest = fastest_turn_deg(posed.even.worn, posed.t_pose.frames);
  warn_of_turn(fastest, warnings);
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
    const NodePresence presence = presence_of(nodes, n, layout.rate_hz);
    const auto& worn = posed.calibration.nodes[n];
    // "called" is the node's name in the stream; null if the stream has no such node.
    each[layout.nodes[n]] = {{"called", choice[n] ? Json(named.names[*choice[n]]) : Json()},
                             {"valid", presence.valid},
                             {"tilt_deg", worn ? Json(worn->tilt_deg) : Json()}};
    valid += presence.valid / static_cast<double>(layout.nodes.size());
    const std::string warning = warning_of(posed, layout, n, presence);
    if (!warning.empty()) warnings.push_back(warning);
  }
  // Warnings about single nodes come first, then those about all nodes.
  for (const std::string& warning : posed.warnings) warnings.push_back(warning);
  Json out{{"valid", valid}, {"nodes", std::move(each)}};
  out.update(calibration_json(
      {static_cast<double>(posed.t_pose.frames.first) / layout.rate_hz,
       static_cast<double>(posed.t_pose.frames.first + posed.t_pose.frames.count) / layout.rate_hz,
       posed.t_pose.found, fastest},
      posed.calibration));
  out["warnings"] = std::move(warnings);
  return out;
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
