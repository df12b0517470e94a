// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/lane_figures.h"

#include "kinalign/view/page/body_figures.h"

#include <algorithm>

namespace kinalign {

/// Makes one lane for the group, or one for each node. Points are green here. TakeFigures corrects
/// the colour when all bodies are known.
LaneFigures::LaneFigures(const TakeGroup& group, std::size_t bins) {
  PageLane lane;
  lane.stream = group.name;
  lane.resampled = group.resampled;
  lane.interval_known = group.interval_known;
  lane.tracked.assign(bins, 0.0f);
  lane.inferred = lane.nearest_raw_s = lane.interval_s = lane.tracked;
  std::vector<std::string> parts{""};
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) {
    joints_ = clip->skeleton.joints();
  } else if (const auto* points = std::get_if<PointGroup>(&group.kind)) {
    lane.colour = PageColour::kinect;
    joints_ = points->joint_names.size();
  } else {
    lane.colour = PageColour::imu;
    parts = std::get<ImuGroup>(group.kind).node_names;
  }
  for (const std::string& part : parts) {
    lane.part = part;
    lanes_.push_back(lane);
  }
  counts_.assign(lanes_.size(), std::vector<Counts>(bins));
}

void LaneFigures::add(const std::variant<ClipRows, PointRows, ImuRows>& rows, std::size_t row,
                      std::size_t bin) {
  if (const auto joints = JointRows::of(rows, joints_)) {
    Counts& counts = counts_[0][bin];
    // A row in which nothing was measured is not counted for distances.
    bool any = false;
    for (std::size_t j = 0; j < joints_; ++j) {
      const Tracking state = joints->state(row, j);
      ++counts.all;
      if (state == Tracking::tracked) ++counts.tracked;
      if (state == Tracking::inferred) ++counts.inferred;
      any = any || state != Tracking::missing;
    }
    const auto* clip = std::get_if<ClipRows>(&rows);
    if (any)
      add_distance(clip != nullptr ? clip->distance : std::get<PointRows>(rows).distance, row, 0,
                   bin);
    return;
  }
  const auto& nodes = std::get<ImuRows>(rows);
  for (std::size_t s = 0; s < lanes_.size(); ++s) {
    const std::size_t sample = row * lanes_.size() + s;
    Counts& counts = counts_[s][bin];
    ++counts.all;
    if (nodes.valid[sample] == 0) continue;
    ++counts.tracked;
    add_distance(nodes.distance, sample, s, bin);
  }
}

void LaneFigures::add_distance(const SampleDistance& distance, std::size_t sample, std::size_t lane,
                               std::size_t bin) {
  // Each bin shows its largest value, because a mean would hide single bad rows.
  const auto enlarge = [sample, bin](std::vector<float>& to, const std::vector<std::int64_t>& ns) {
    if (sample >= ns.size()) return;
    to[bin] = std::max(to[bin], static_cast<float>(1e-9 * static_cast<double>(ns[sample])));
  };
  enlarge(lanes_[lane].nearest_raw_s, distance.nearest_raw_ns);
  enlarge(lanes_[lane].interval_s, distance.time_interval_ns);
}

// Counts are converted to shares after the last row.
std::vector<PageLane> LaneFigures::finish() {
  const auto share = [](std::uint64_t part, std::uint64_t all) {
    return all == 0 ? 0.0f
                    : static_cast<float>(static_cast<double>(part) / static_cast<double>(all));
  };
  for (std::size_t l = 0; l < lanes_.size(); ++l) {
    for (std::size_t b = 0; b < counts_[l].size(); ++b) {
      const Counts& counts = counts_[l][b];
      lanes_[l].tracked[b] = share(counts.tracked, counts.all);
      lanes_[l].inferred[b] = share(counts.inferred, counts.all);
    }
  }
  return std::move(lanes_);
}

}  // namespace kinalign
