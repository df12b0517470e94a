// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/live_nodes.h"

#include "kinalign/motion/frame_arrays.h"

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

// Age of the oldest kept sample, before the newest frame.
constexpr Duration kept = std::chrono::seconds(1);
constexpr std::size_t most_kept = 4096;  // samples per node

void insert_numbers(std::size_t at, std::span<const double> numbers, std::vector<double>& all) {
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(at * numbers.size());
  all.insert(place, numbers.begin(), numbers.end());
}

}  // namespace

LiveNodes::LiveNodes(std::size_t nodes, double rate_hz) : rate_hz_(rate_hz), nodes_(nodes) {}

/// True if the sample has all that its node's first sample had and can be completed.
bool LiveNodes::fits(const Node& node, const NodeReadings& sample) {
  if (!sample.acceleration) return false;
  if (!sample.orientation && (!sample.angular_velocity || !sample.gravity)) return false;
  if (node.track.stamps.empty()) return true;
  return sample.orientation.has_value() >= node.has_orientation &&
         sample.angular_velocity.has_value() >= node.has_angular_velocity &&
         sample.gravity == node.track.gravity;
}

/// Inserts a sample in the order of stamps. The orientation filter needs samples in that order, so
/// add() drops those that arrive out of order if the node sends no orientation.
void LiveNodes::insert(Node& node, const NodeReadings& sample) {
  Quat q = sample.orientation.value_or(Quat::Identity());
  if (!node.has_orientation) {
    const double step =
        // The first step is that of even_nodes.cpp.
        node.filtered ? seconds(sample.stamp - *node.filtered) : 1e-3;
    node.filter.update(step, {*sample.angular_velocity, *sample.acceleration});
    node.filtered = sample.stamp;
    q = node.filter.orientation();
  }
  NodeTrack& track = node.track;
  const auto place = std::lower_bound(track.stamps.begin(), track.stamps.end(), sample.stamp);
  const auto at = static_cast<std::size_t>(place - track.stamps.begin());
  track.stamps.insert(place, sample.stamp);
  insert_numbers(at, std::array{q.w(), q.x(), q.y(), q.z()}, track.orientation);
  insert_numbers(at, std::span(sample.acceleration->data(), 3), track.acceleration);
  if (node.has_angular_velocity) {
    insert_numbers(at, std::span(sample.angular_velocity->data(), 3), track.angular_velocity);
  }
}

void LiveNodes::add(std::size_t number, const NodeReadings& sample) {
  Node& node = nodes_[number];
  NodeTrack& track = node.track;
  if (track.stamps.empty()) {
    node.has_orientation = sample.orientation.has_value();
    node.has_angular_velocity = sample.angular_velocity.has_value();
    track.gravity = sample.gravity;
  }
  // The filter of orientations can't go back in time.
  const bool out_of_order =
      !node.has_orientation && node.filtered && sample.stamp <= *node.filtered;
  const bool twice = std::binary_search(track.stamps.begin(), track.stamps.end(), sample.stamp);
  if (!fits(node, sample) || out_of_order || twice || track.stamps.size() == most_kept) {
    ++left_out_;
    return;
  }
  if (made_ && sample.stamp <= *made_) ++late_;
  insert(node, sample);
  node.arrival = std::max(node.arrival, sample.arrival);
  if (number + 1 == nodes_.size() && !begin_) begin_ = sample.stamp;
}

std::optional<Time> LiveNodes::newest_of_root() const {
  const auto& stamps = nodes_.back().track.stamps;
  return stamps.empty() ? std::nullopt : std::optional(stamps.back());
}

bool LiveNodes::is_ready(Time time, Time now) const {
  if (now >= time + reach + patience) return true;
  if (now < time + reach) return false;
  return std::all_of(nodes_.begin(), nodes_.end(), [&](const Node& node) {
    const auto& stamps = node.track.stamps;
    return stamps.empty() || stamps.back() >= time + reach || now - node.arrival > silence;
  });
}

void LiveNodes::forget_before(Time time, Node& node) {
  NodeTrack& track = node.track;
  // The newest sample is kept: it shows that the node exists and what it measures.
  const auto end = track.stamps.empty() ? track.stamps.end() : track.stamps.end() - 1;
  const auto count = std::lower_bound(track.stamps.begin(), end, time) - track.stamps.begin();
  const auto samples = static_cast<std::size_t>(count);
  erase_first(track.stamps, samples);
  erase_first(track.orientation, 4 * samples);
  erase_first(track.acceleration, 3 * samples);
  // A node may have no angular velocities.
  if (!track.angular_velocity.empty()) erase_first(track.angular_velocity, 3 * samples);
}

WornFrames LiveNodes::frame(Time time) {
  WornFrames out = lost_nodes(1, nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    forget_before(time - kept, nodes_[n]);
    NodeTrack track = nodes_[n].track;
    if (!complete(track)) continue;  // cannot happen: add() drops samples that can't be completed
    put_node(track, {time, 1}, rate_hz_, n, out);
  }
  made_ = time;
  return out;
}

}  // namespace kinalign
