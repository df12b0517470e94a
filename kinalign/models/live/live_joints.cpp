// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/live/live_joints.h"

#include "kinalign/models/joint_names.h"
#include "kinalign/motion/frame_arrays.h"
#include "kinalign/motion/kinect_joints.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t joints = kinect_joints.size();
constexpr double longest_gap_s = 0.2;  // longest gap that is interpolated
/// Age of the oldest kept row, before the newest frame.
constexpr Duration kept_rows = std::chrono::seconds(1);
constexpr std::size_t most_rows = 512;

}  // namespace

LiveJoints::LiveJoints(const std::vector<std::string>& wanted, double rate_hz) : rate_hz_(rate_hz) {
  const auto names = kinect_names({kinect_joints.begin(), kinect_joints.end()});
  for (const std::string& name : wanted) places_.push_back(index_of(names, name));
}

void LiveJoints::add(const PointFrames& row, Time arrival) {
  const Time stamp = row.stamps.front();
  const auto place = std::lower_bound(rows_.stamps.begin(), rows_.stamps.end(), stamp);
  const bool twice = place != rows_.stamps.end() && *place == stamp;
  if (twice || rows_.size() == most_rows) return;
  const auto at = place - rows_.stamps.begin();
  rows_.stamps.insert(place, stamp);
  rows_.positions.insert(rows_.positions.begin() + at * static_cast<std::ptrdiff_t>(3 * joints),
                         row.positions.begin(), row.positions.end());
  rows_.state.insert(rows_.state.begin() + at * static_cast<std::ptrdiff_t>(joints),
                     row.state.begin(), row.state.end());
  if (!begin_) begin_ = stamp;
  arrival_ = std::max(arrival_, arrival);
}

std::optional<Time> LiveJoints::newest() const {
  return rows_.stamps.empty() ? std::nullopt : std::optional(rows_.stamps.back());
}

// Two rows are needed to interpolate. If the Kinect is late or silent, the frame is made without
// it, because the run must go on.
bool LiveJoints::is_ready(Time time, Time now) const {
  if (rows_.stamps.empty() || (rows_.size() > 1 && rows_.stamps.back() >= time)) return true;
  return now >= time + patience || (now >= time && now - arrival_ > silence);
}

JointFrames LiveJoints::frame(Time time) {
  // The newest row is always kept: it shows when the Kinect last sent joints.
  const auto end = rows_.stamps.empty() ? rows_.stamps.end() : rows_.stamps.end() - 1;
  const auto old =
      std::lower_bound(rows_.stamps.begin(), end, time - kept_rows) - rows_.stamps.begin();
  const auto count = static_cast<std::size_t>(old);
  erase_first(rows_.stamps, count);
  erase_first(rows_.positions, 3 * joints * count);
  erase_first(rows_.state, joints * count);
  const std::size_t wanted = places_.size();
  if (rows_.size() < 2) {
    return {wanted, std::vector<float>(3 * wanted), std::vector<std::uint8_t>(wanted)};
  }
  return joints_on_grid(places_, rows_, {rate_hz_, longest_gap_s, EvenSpan{time, 1}});
}

}  // namespace kinalign
