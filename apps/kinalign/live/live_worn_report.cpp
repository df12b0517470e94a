// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_worn_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr double longest_lost_s = 2.0;  // a node that is lost for longer gets a warning

/// Converts a sample to the form that calibration uses: double in place of float, and a normalised
/// orientation.
NodeReadings readings_of(const LiveNodeSample& one) {
  const NodeSample& sample = one.sample;
  NodeReadings out{one.stamp, one.arrival, {}, {}, {}, true};
  const auto vector = [](const std::array<float, 3>& v) {
    return Vec3(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
  };
  if (sample.has_orientation) {
    const auto& q = sample.orientation;
    out.orientation = Quat(static_cast<double>(q[0]), static_cast<double>(q[1]),
                           static_cast<double>(q[2]), static_cast<double>(q[3]))
                          .normalized();
  }
  if (sample.has_acceleration) {
    out.acceleration = vector(sample.acceleration);
    // A device that removes gravity from its acceleration can't show how it is tilted. Calibration
    // must know that.
    out.gravity = sample.gravity_included;
  }
  if (sample.has_angular_velocity) out.angular_velocity = vector(sample.angular_velocity);
  return out;
}

}  // namespace

Json calibration_json(const UsedTPose& t_pose, const NodeCalibration& found) {
  return {{"t_pose",
           {{"from_s", t_pose.from_s},
            {"to_s", t_pose.to_s},
            {"found", t_pose.found},
            {"fastest_deg_s", t_pose.fastest_deg_s}}},
          {"headings", found.headings == Headings::shared ? "shared" : "mounting"},
          {"facing", found.facing == Facing::arms ? "arms" : "mounting"},
          {"spread_deg", found.spread_deg},
          {"worn_as_told", found.worn_as_described}};
}

void warn_of_turn(double fastest_deg_s, Json& warnings) {
  if (fastest_deg_s <= most_turn_deg_s) return;
  warnings.push_back(fmt::format(
      "a node turned at {:.0f} deg/s in the T-pose: the person did not hold still", fastest_deg_s));
}

// A node that sent nothing and a node that sent nothing during the T-pose have different causes, so
// the user gets different texts.
std::string missing_warning(const std::string& node, bool has_samples, bool is_used,
                            double lost_s) {
  if (!has_samples) return node + " has no samples: its limb is a guess";
  if (!is_used) return node + " has no samples in the T-pose and is left out: its limb is a guess";
  if (lost_s < longest_lost_s) return "";
  return fmt::format("{} is missing for {:.1f} s: during this time its limb is a guess", node,
                     lost_s);
}

LiveWornReport::LiveWornReport(const PoseLayout& layout, const std::string& stream, LiveWorn& worn,
                               LiveSession& session)
    : layout_(&layout),
      worn_(&worn),
      session_(&session),
      names_(layout, stream),
      presence_(layout.nodes.size()),
      missing_(layout.nodes.size()) {}

std::string LiveWornReport::instruction() {
  return "T-pose: stand upright, arms straight out to the sides, palms down, and hold still for "
         "three seconds";
}

Result<bool> LiveWornReport::add(const LiveNodeSample& sample) {
  const auto node = KA_TRY(names_.find(*sample.node));
  if (node) worn_->add(*node, readings_of(sample));
  return node.has_value();
}

void LiveWornReport::take(const LiveMark& mark) {
  // Other kinds of marks are for the recorder: they begin and end takes.
  if (mark.mark.mark.kind != Mark::Kind::t_pose) return;
  // Each mark is a new attempt, so a refusal is reported again even for the same reason.
  refusal_.clear();
  // Frames begin at the first sample of the root's node, so an earlier mark belongs to no frame.
  if (!worn_->nodes().begin())
    return report_refusal("the mark came before the first sample of " + layout_->nodes.back());
  worn_->mark_t_pose(mark.at);
  session_->report("T-pose marked: hold still for two seconds", Json{{"event", "t_pose_marked"}});
}

/// Reports that a T-pose was refused. The same reason is reported once until the next mark.
void LiveWornReport::report_refusal(const std::string& why) {
  if (why == refusal_) return;
  refusal_ = why;
  session_->report((worn_->calibration() ? "T-pose refused, the previous T-pose stays in use: "
                                         : "no T-pose yet: ") +
                       why,
                   Json{{"event", "t_pose_refused"}, {"found", why}});
}

bool LiveWornReport::report_t_pose() {
  if (const auto why = worn_->take_refusal()) report_refusal(*why);
  // Each T-pose has another first frame, which therefore tells whether the calibration is new.
  if (!worn_->calibration() || worn_->calibration()->first == reported_) return false;
  reported_ = worn_->calibration()->first;
  refusal_.clear();
  Json event{{"event", "calibrated"}};
  event.update(calibration());
  const Json& t_pose = event.at("t_pose");
  session_->report(fmt::format("T-pose from {:.1f} to {:.1f} s accepted: you may move",
                               t_pose.at("from_s").get<double>(), t_pose.at("to_s").get<double>()),
                   event);
  return true;
}

void LiveWornReport::watch(const std::vector<std::uint8_t>& valid) {
  const auto longest = static_cast<std::size_t>(longest_lost_s * layout_->rate_hz);
  for (std::size_t n = 0; n < missing_.size(); ++n) {
    const std::string& name = layout_->nodes[n];
    const std::size_t before = missing_[n];
    missing_[n] = valid[n] != 0 ? 0 : before + 1;
    // The loss is reported once, in the frame in which it reaches the limit.
    if (missing_[n] == longest) {
      session_->report(name + " has been missing for 2 s: its limb is a guess",
                       Json{{"event", "node_missing"}, {"node", name}});
      // A node that was switched off has a new heading when it starts again. Only a new T-pose can
      // measure that heading.
    } else if (missing_[n] == 0 && before >= longest) {
      session_->report(name + " sends again; if it was switched off, mark a new T-pose",
                       Json{{"event", "node_back"}, {"node", name}});
    }
  }
}

void LiveWornReport::count(const std::vector<std::uint8_t>& valid) {
  ++frames_;
  for (std::size_t n = 0; n < presence_.size(); ++n) {
    Presence& one = presence_[n];
    one.valid += valid[n] != 0 ? 1 : 0;
    one.lost = valid[n] != 0 ? 0 : one.lost + 1;
    one.longest = std::max(one.longest, one.lost);
  }
}

std::string LiveWornReport::waits_for() const {
  // Before the root's node has sent a sample, begin() is empty.
  if (!worn_->nodes().begin()) return "waiting for the nodes: " + names_.text();
  if (worn_->calibration()) return "";
  return fmt::format("waiting for a T-pose that is held still for a second ({}){}", names_.text(),
                     refusal_.empty() ? "" : "; " + refusal_);
}

Json LiveWornReport::calibration() const {
  const LiveCalibration& found = *worn_->calibration();
  const double rate = layout_->rate_hz;
  return calibration_json(
      {static_cast<double>(found.first) / rate,
       static_cast<double>(found.first + found.count) / rate, found.found, found.fastest_deg_s},
      found.nodes);
}

Json LiveWornReport::about() const {
  const double all = static_cast<double>(std::max<std::size_t>(frames_, 1));
  Json nodes = Json::object(), warnings = Json::array();
  double valid = 0.0;
  for (std::size_t n = 0; n < presence_.size(); ++n) {
    const auto& worn = worn_->calibration()->nodes.nodes[n];
    const double share = static_cast<double>(presence_[n].valid) / all;
    valid += share / static_cast<double>(presence_.size());
    nodes[layout_->nodes[n]] = {{"called", names_.called()[n]},
                                {"valid", share},
                                {"tilt_deg", worn ? Json(worn->tilt_deg) : Json()}};
    const bool is_used = presence_[n].valid > 0;
    const std::string warning =
        missing_warning(layout_->nodes[n], is_used || worn_->nodes().has_samples(n), is_used,
                        static_cast<double>(presence_[n].longest) / layout_->rate_hz);
    if (!warning.empty()) warnings.push_back(warning);
  }
  Json out{{"valid", valid}, {"nodes", std::move(nodes)}};
  out.update(calibration());
  // Late samples are those that came after their frame had been made.
  out["late_samples"] = worn_->nodes().late();
  warn_of_turn(worn_->calibration()->fastest_deg_s, warnings);
  // If a node is not used by the model, its place is often missing in lab.toml.
  for (const std::string& other : names_.others()) {
    warnings.push_back(other + " is not a node of the model: state in lab.toml where it is worn");
  }
  out["warnings"] = std::move(warnings);
  return out;
}

}  // namespace kinalign
