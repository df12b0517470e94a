// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/numbers.h"
#include "kinalign/formats/bvh/write.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr double centimetres = 100.0;

/// Angles a, b, c in degrees with rotation = Rz(a) Rx(b) Ry(c).
std::array<double, 3> zxy_angles(const Quat& rotation) {
  const Eigen::Matrix3d r = rotation.normalized().toRotationMatrix();
  constexpr double degrees = 180.0 / std::numbers::pi;
  const double sin_x = std::clamp(r(2, 1), -1.0, 1.0);
  if (std::abs(sin_x) > 1.0 - 1e-12) {  // both other turns are about one axis: give it to z
    return {std::atan2(r(1, 0), r(0, 0)) * degrees, std::asin(sin_x) * degrees, 0.0};
  }
  return {std::atan2(-r(0, 1), r(1, 1)) * degrees, std::asin(sin_x) * degrees,
          std::atan2(-r(2, 0), r(2, 2)) * degrees};
}

/// Every joint directly followed by all below it, children in the order they had.
std::vector<std::size_t> nested_order(const std::vector<int>& parents) {
  std::vector<std::vector<std::size_t>> children(parents.size() + 1);  // the last: roots
  for (std::size_t j = parents.size(); j-- > 0;) {
    children[parents[j] < 0 ? parents.size() : static_cast<std::size_t>(parents[j])].push_back(j);
  }
  std::vector<std::size_t> order;
  std::vector<std::size_t> open = children.back();  // the next one last
  while (!open.empty()) {
    order.push_back(open.back());
    open.pop_back();
    const auto& below = children[order.back()];
    open.insert(open.end(), below.begin(), below.end());
  }
  return order;
}

}  // namespace

BvhChannels::BvhChannels(const Skeleton& skeleton, Positions positions)
    : skeleton_(skeleton),
      order_(nested_order(skeleton.parents)),
      moves_(skeleton.joints(), positions == Positions::of_all) {}

void BvhChannels::see(std::span<const double> local_positions) {
  const std::size_t joints = skeleton_.joints();
  for (std::size_t i = 0; 3 * i < local_positions.size(); ++i) {
    const std::size_t j = i % joints;
    if (moves_[j]) continue;
    moves_[j] = (Vec3(vec3(local_positions, i)) - skeleton_.rest_offsets[j]).norm() > 1e-6;
  }
}

BvhHierarchy BvhChannels::hierarchy(std::uint64_t frames, double frame_seconds) const {
  BvhHierarchy h;
  std::vector<int> place(skeleton_.joints());  // of a joint in the order written
  for (const std::size_t j : order_) {
    const int parent = skeleton_.parents[j];
    place[j] = static_cast<int>(h.names.size());
    h.names.push_back(skeleton_.joint_names[j]);
    h.parents.push_back(parent < 0 ? -1 : place[static_cast<std::size_t>(parent)]);
    h.offsets.emplace_back(skeleton_.rest_offsets[j] * centimetres);
    h.channels.push_back(has_position(j) ? std::vector<Channel>{0, 1, 2, 5, 3, 4}
                                         : std::vector<Channel>{5, 3, 4});
  }
  for (const EndSite& site : skeleton_.end_sites) {
    h.end_sites.push_back(
        {place[static_cast<std::size_t>(site.parent)], site.offset * centimetres});
  }
  h.frames = frames;
  h.frame_seconds = frame_seconds;
  std::array<char, number_room> room{};
  h.frame_time.assign(room.data(), put_number(room.data(), frame_seconds, 7));
  return h;
}

void BvhChannels::append(std::span<const double> local_positions,
                         std::span<const double> local_rotations,
                         std::vector<double>& values) const {
  // Rounded to the written decimals, so that the text holds exactly these values.
  const auto keep = [&values](double value) {
    values.push_back(std::nearbyint(value * 1e6) / 1e6);
  };
  const std::size_t joints = skeleton_.joints();
  for (std::size_t row = 0; 4 * row < local_rotations.size(); row += joints) {
    for (const std::size_t j : order_) {
      if (has_position(j)) {
        const Vec3 at = vec3(local_positions, row + j);
        for (int k = 0; k < 3; ++k) keep(at[k] * centimetres);
      }
      for (const double angle : zxy_angles(quat(local_rotations, row + j))) keep(angle);
    }
  }
}

BvhFile bvh_from_clip(Clip clip, double frame_seconds) {
  BvhFile file;
  BvhChannels channels(clip.skeleton);
  channels.see(clip.frames.local_positions);
  file.hierarchy = channels.hierarchy(clip.frames.size(), frame_seconds);
  channels.append(clip.frames.local_positions, clip.frames.local_rotations, file.values);
  file.clip = std::move(clip);
  return file;
}

}  // namespace kinalign
