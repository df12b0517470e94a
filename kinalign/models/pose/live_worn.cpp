// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/live_worn.h"

#include "kinalign/motion/stamps.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// Time between attempts at a calibration that needs later frames.
constexpr double between_tries_s = 0.5;

WornFrames frames_from(const WornFrames& all, std::size_t first) {
  WornFrames out = all;
  erase_first_frames(out, first);
  return out;
}

/// The name of the first arm node whose tilt shows that the arm is not in a T-pose; null if there
/// is none.
const std::string* hanging_arm(const PoseLayout& layout, const NodeCalibration& calibration) {
  const bool is_checked =
      calibration.worn_as_described || calibration.headings == Headings::mounting;
  for (std::size_t n = 0; n < layout.nodes.size() && is_checked; ++n) {
    const WornPlace* place = worn_place(layout.nodes[n]);
    const auto& node = calibration.nodes[n];
    if (node && place != nullptr && place->on_arm && node->tilt_deg > most_tilt_deg) {
      return &layout.nodes[n];
    }
  }
  return nullptr;
}

}  // namespace

LiveWorn::LiveWorn(const PoseLayout& layout, const Skeleton& body, const LiveWornOptions& options)
    : layout_(&layout),
      body_(&body),
      options_(options),
      nodes_(layout.nodes.size(), layout.rate_hz) {
  recent_.nodes = layout.nodes.size();
}

Time LiveWorn::time_of(std::size_t frame) const {
  return grid_stamp(*nodes_.begin(), layout_->rate_hz, frame);
}

void LiveWorn::advance(Time now, const Also& also, std::vector<LiveWornFrame>& out) {
  while (nodes_.begin() && nodes_.is_ready(time_of(made_), now) && also(time_of(made_))) {
    make_frame(out);
  }
}

void LiveWorn::finish(std::vector<LiveWornFrame>& out) {
  while (nodes_.begin() && time_of(made_) <= *nodes_.newest_of_root()) make_frame(out);
}

/// Makes the next frame, looks for a T-pose, and outputs calibrated frames.
void LiveWorn::make_frame(std::vector<LiveWornFrame>& out) {
  append_frames(recent_, nodes_.frame(time_of(made_)));
  ++made_;
  look_for_t_pose();
  if (calibration_) hand_on(out);
  const auto most = static_cast<std::size_t>(most_waiting_s * layout_->rate_hz);
  if (recent_.frames() <= most) return;
  erase_first_frames(recent_, 1);
  ++forgotten_;
  searched_ -= std::min<std::size_t>(searched_, 1);
  handed_on_ -= std::min<std::size_t>(handed_on_, 1);
}

/// The T-pose to calibrate by, in frames of recent_; absent if it has not ended yet.
std::optional<TPose> LiveWorn::wanted_t_pose() const {
  const double rate = layout_->rate_hz;
  if (marked_ || options_.t_pose) {
    // Seconds count from the grid's first frame; `first` and `last` are indices of recent_.
    const double begin = marked_ ? seconds(*marked_ - *nodes_.begin()) : options_.t_pose->from;
    const double end = marked_ ? begin + held_s : options_.t_pose->to;
    const double first = std::max(std::ceil(begin * rate) - static_cast<double>(forgotten_), 0.0);
    const double last = std::floor(end * rate) - static_cast<double>(forgotten_);
    if (last >= static_cast<double>(recent_.frames()) || last < first) return std::nullopt;
    return TPose{static_cast<std::size_t>(first), static_cast<std::size_t>(last - first) + 1};
  }
  const auto still = first_still(frames_from(recent_, searched_), rate);
  if (!still) return std::nullopt;
  const TPose found{still->first + searched_, still->count};
  const bool goes_on = found.first + found.count == recent_.frames() &&
                       // first_still() returns at most 3 s.
                       static_cast<double>(found.count) < 3.0 * rate;
  return goes_on ? std::nullopt : std::optional(found);
}

/// Looks for a T-pose and calibrates by it. The person's heading may show only when the arms come
/// down. A T-pose that can't be used yet is therefore tried again, until its frames are dropped.
void LiveWorn::look_for_t_pose() {
  if (marked_ && *marked_ < time_of(forgotten_)) marked_.reset();
  if (calibration_ && !marked_) return;
  const auto between = static_cast<std::size_t>(between_tries_s * layout_->rate_hz);
  if (tried_ != 0 && made_ < tried_ + between) return;
  const auto t_pose = wanted_t_pose();
  if (!t_pose) return;
  tried_ = made_;
  if (!take_t_pose(*t_pose)) return;
  tried_ = 0;
  marked_.reset();
}

/// The reason why a calibration can't be used; absent if it can. A later T-pose must calibrate all
/// nodes that were calibrated before. A T-pose given by the options is used as it is if enough
/// nodes sent samples.
std::optional<std::string> LiveWorn::fault_of(const NodeCalibration& found) const {
  const auto sent = std::count_if(found.nodes.begin(), found.nodes.end(),
                                  [](const auto& node) { return node.has_value(); });
  if (sent < static_cast<std::ptrdiff_t>(least_nodes)) {
    return "fewer than three nodes have samples in it";
  }
  if (!marked_ && options_.t_pose) return std::nullopt;
  const std::string* const arm = hanging_arm(*layout_, found);
  if (arm != nullptr) return *arm + " is not in a T-pose";
  for (std::size_t n = 0; n < layout_->nodes.size() && calibration_; ++n) {
    const bool was_there = calibration_->nodes.nodes[n].has_value();
    if (was_there && !found.nodes[n]) return layout_->nodes[n] + " has no samples in it";
  }
  return std::nullopt;
}

/// Calibrates by one stretch of frames; false if it was refused. A stretch given by the options is
/// used as it is. Any other stretch is refused if fault_of() finds a fault. If a mark gave it, it
/// is also refused if the person moves in it.
bool LiveWorn::take_t_pose(const TPose& t_pose) {
  const double fastest = fastest_turn_deg(recent_, t_pose);
  if (marked_ && fastest > most_turn_deg_s) {
    refusal_ = "a node turned at " + std::to_string(std::lround(fastest)) +
               " deg/s: the person did not hold still";
    forget_t_pose(t_pose);
    return false;
  }
  CalibrationOptions options;
  options.t_pose = t_pose;
  options.headings = options_.headings;
  const auto found = calibrate(*layout_, *body_, recent_, options);
  if (!found) {
    refusal_ = "expected " + found.error().expected + ", found " + found.error().found;
    return false;
  }
  refusal_ = fault_of(*found);
  if (refusal_) {
    forget_t_pose(t_pose);
    return false;
  }
  calibration_ = LiveCalibration{*found, forgotten_ + t_pose.first, t_pose.count, fastest,
                                 !marked_ && !options_.t_pose};
  return true;
}

/// Excludes this T-pose from further attempts.
void LiveWorn::forget_t_pose(const TPose& t_pose) {
  if (!marked_) searched_ = t_pose.first + t_pose.count;
  marked_.reset();
  tried_ = 0;
}

void LiveWorn::hand_on(std::vector<LiveWornFrame>& out) {
  for (; handed_on_ < recent_.frames(); ++handed_on_) {
    out.push_back({time_of(forgotten_ + handed_on_),
                   on_bones(calibration_->nodes, frame_at(recent_, handed_on_))});
  }
}

}  // namespace kinalign
