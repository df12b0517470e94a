// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/crops.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

/// A time between two frames.
struct Moment {
  std::size_t before = 0, after = 0;
  float share = 0.0F;  // 0 at `before`, 1 at `after`

  template <typename T>
  T between(const T& a, const T& b) const {
    return a + share * (b - a);
  }
};

/// The place of frame i of the crop in the sequence. Beyond the end the last frame is repeated.
Moment moment_of(const Crop& crop, std::size_t i, std::size_t frames) {
  const double last = static_cast<double>(frames - 1);
  const double at = std::min(
      static_cast<double>(crop.begin) + crop.variation.speed * static_cast<double>(i), last);
  const auto before = static_cast<std::size_t>(at);
  return {before, std::min(before + 1, frames - 1),
          static_cast<float>(at - static_cast<double>(before))};
}

Eigen::Vector3f vector_at(const std::vector<float>& from, std::size_t at) {
  return Eigen::Vector3f(&from[3 * at]);
}

Eigen::Quaternionf turn_at(const std::vector<float>& from, std::size_t at) {
  return {from[4 * at], from[4 * at + 1], from[4 * at + 2], from[4 * at + 3]};
}

void append_vector(std::vector<float>& out, const Eigen::Vector3f& vector) {
  out.insert(out.end(), vector.begin(), vector.end());
}

/// The mirror images of vectors and of angular velocities in the plane x = 0. A rotation goes the
/// other way about the mirrored axis.
Eigen::Vector3f in_mirror(const Eigen::Vector3f& v) { return {-v.x(), v.y(), v.z()}; }
Eigen::Vector3f rate_in_mirror(const Eigen::Vector3f& v) { return {v.x(), -v.y(), -v.z()}; }
Eigen::Quaternionf in_mirror(const Eigen::Quaternionf& q) { return {q.w(), q.x(), -q.y(), -q.z()}; }
// The mirror image of the rotation R is S R S with S = diag(-1, 1, 1).
Turn in_mirror(const Turn& turn) {
  const Eigen::Vector3f signs(-1.0F, 1.0F, 1.0F);
  return signs.asDiagonal() * turn * signs.asDiagonal();
}

/// The index of the node, bone or joint from which index `at` of the crop is taken.
std::size_t source_of(const Crop& crop, const std::vector<std::size_t>& partners, std::size_t at) {
  return crop.variation.mirrored ? partners[at] : at;
}

/// Appends one sample of a node. Angular velocities change with the speed of the crop,
/// accelerations with its square. A larger body that moves in the same way also has larger
/// accelerations, so size is a factor, too.
void append_node(const NodeFrames& nodes, const Moment& moment, std::size_t n,
                 const Variation& variation, NodeFrames& out) {
  const std::size_t a = moment.before * nodes.nodes + n, b = moment.after * nodes.nodes + n;
  Eigen::Quaternionf turn =
      turn_at(nodes.orientation, a).slerp(moment.share, turn_at(nodes.orientation, b));
  const auto speed = static_cast<float>(variation.speed), size = static_cast<float>(variation.size);
  const auto between = [&](const std::vector<float>& values) -> Eigen::Vector3f {
    return moment.between(vector_at(values, a), vector_at(values, b));
  };
  Eigen::Vector3f acceleration = size * speed * speed * between(nodes.acceleration);
  Eigen::Vector3f rate = speed * between(nodes.angular_velocity);
  if (variation.mirrored) {
    turn = in_mirror(turn);
    acceleration = in_mirror(acceleration);
    rate = rate_in_mirror(rate);
  }
  out.orientation.insert(out.orientation.end(), {turn.w(), turn.x(), turn.y(), turn.z()});
  append_vector(out.acceleration, acceleration);
  append_vector(out.angular_velocity, rate);
  out.valid.push_back(std::min(nodes.valid[a], nodes.valid[b]));
}

}  // namespace

Variation draw_variation(const Variety& variety, const RandomStream& random) {
  const auto about_one = [&](double most, std::uint64_t lane) {
    // A speed-up and a slow-down by the same factor are equally likely.
    return std::pow(1.0 + most, 2.0 * random.uniform(1, lane) - 1.0);
  };
  return {random.chance(1, 0, variety.mirrored), about_one(variety.speed, 1),
          about_one(variety.size, 2)};
}

std::size_t Crop::source_frames() const {
  if (count == 0) return 0;
  return static_cast<std::size_t>(std::ceil(variation.speed * static_cast<double>(count - 1))) + 1;
}

Sides::Sides(const PoseBody& body, const std::vector<std::string>& node_names,
             const std::vector<std::string>& kinect_names)
    : nodes(mirror_partners(node_names)),
      bones(mirror_partners(body.bones)),
      joints(mirror_partners(body.skeleton.joint_names)),
      kinect(mirror_partners(kinect_names)) {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const bool has_side = node_names[n].ends_with("_left") || node_names[n].ends_with("_right");
    can_mirror = can_mirror && (!has_side || nodes[n] != n);
  }
}

NodeFrames crop_of(const NodeFrames& nodes, const Crop& crop, const Sides& sides) {
  NodeFrames out;
  out.nodes = nodes.nodes;
  for (std::size_t i = 0; i < crop.count; ++i) {
    const Moment moment = moment_of(crop, i, nodes.frames());
    for (std::size_t n = 0; n < nodes.nodes; ++n) {
      append_node(nodes, moment, source_of(crop, sides.nodes, n), crop.variation, out);
    }
  }
  return out;
}

JointFrames crop_of(const JointFrames& kinect, const Crop& crop, const Sides& sides) {
  JointFrames out{.joints = kinect.joints, .positions = {}, .seen = {}};
  const auto size = static_cast<float>(crop.variation.size);
  for (std::size_t i = 0; i < crop.count; ++i) {
    const Moment moment = moment_of(crop, i, kinect.frames());
    for (std::size_t j = 0; j < kinect.joints; ++j) {
      const std::size_t a = moment.before * kinect.joints + j, b = moment.after * kinect.joints + j;
      // If the time is exactly that of a frame, the next frame is not needed.
      const std::uint8_t seen =
          moment.share > 0.0F ? std::min(kinect.seen[a], kinect.seen[b]) : kinect.seen[a];
      const Eigen::Vector3f place =
          moment.between(vector_at(kinect.positions, a), vector_at(kinect.positions, b));
      append_vector(out.positions,
                    seen == 0 ? Eigen::Vector3f(Eigen::Vector3f::Zero()) : size * place);
      out.seen.push_back(seen);
    }
  }
  if (crop.variation.mirrored) mirror(out, sides.kinect);
  return out;
}

PoseSequence crop_of(const PoseSequence& sequence, const Crop& crop, const Sides& sides) {
  PoseSequence out;
  out.nodes = crop_of(sequence.nodes, crop, sides);
  const std::size_t bones = sides.bones.size();
  const double size = crop.variation.size;
  const Vec3 signs(crop.variation.mirrored ? -1.0 : 1.0, 1.0, 1.0);
  for (std::size_t i = 0; i < crop.count; ++i) {
    const Moment moment = moment_of(crop, i, sequence.frames());
    for (std::size_t b = 0; b < bones; ++b) {
      const std::size_t from = source_of(crop, sides.bones, b);
      const Turn& before = sequence.rotations[moment.before * bones + from];
      const Turn& after = sequence.rotations[moment.after * bones + from];
      // A mean of two matrices is no rotation, so it is converted to one.
      const Turn turn =
          moment.share > 0.0F ? turned_back_to_rotation(moment.between(before, after)) : before;
      out.rotations.push_back(crop.variation.mirrored ? in_mirror(turn) : turn);
    }
    const Vec3& before = sequence.places[moment.before];
    const Vec3& after = sequence.places[moment.after];
    const Vec3 place = before + static_cast<double>(moment.share) * (after - before);
    out.places.emplace_back(size * signs.cwiseProduct(place));
  }
  for (std::size_t j = 0; j < sequence.rest_offsets.size(); ++j) {
    const Vec3& offset = sequence.rest_offsets[source_of(crop, sides.joints, j)];
    out.rest_offsets.emplace_back(size * signs.cwiseProduct(offset));
  }
  return out;
}

}  // namespace kinalign
