// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/skeleton_of_points.h"

#include "kinalign/models/joint_names.h"
#include "kinalign/motion/stamps.h"

#include <Eigen/SVD>

#include <array>
#include <optional>
#include <string_view>

namespace kinalign {

namespace {

/// The direction to a joint from its parent.
struct Direction {
  std::string_view joint;
  double x, y, z;
};

/// Directions in a T-pose that faces +z.
/// x points to the person's left, y up. The names are the Kinect's.
constexpr std::array<Direction, 20> rest_directions{
    {{"SpineMid", 0, 1, 0},    {"SpineShoulder", 0, 1, 0}, {"Neck", 0, 1, 0},
     {"Head", 0, 1, 0},        {"ShoulderLeft", 1, 0, 0},  {"ElbowLeft", 1, 0, 0},
     {"WristLeft", 1, 0, 0},   {"HandLeft", 1, 0, 0},      {"ShoulderRight", -1, 0, 0},
     {"ElbowRight", -1, 0, 0}, {"WristRight", -1, 0, 0},   {"HandRight", -1, 0, 0},
     {"HipLeft", 1, 0, 0},     {"KneeLeft", 0, -1, 0},     {"AnkleLeft", 0, -1, 0},
     {"FootLeft", 0, 0, 1},    {"HipRight", -1, 0, 0},     {"KneeRight", 0, -1, 0},
     {"AnkleRight", 0, -1, 0}, {"FootRight", 0, 0, 1}}};

std::optional<Vec3> known_direction(const std::string& joint) {
  for (const Direction& known : rest_directions) {
    if (known.joint == joint) return Vec3{known.x, known.y, known.z};
  }
  return std::nullopt;
}

/// The tree from its root outward, and the clip's joint that turns each bone. A joint of a skeleton
/// has one rotation, but each of its bones needs its own direction. A point with several children
/// therefore gets one extra joint for each child, which turns the bone to that child.
struct Plan {
  std::vector<std::size_t> order;                  // indices of the points, root first
  std::vector<std::vector<std::size_t>> children;  // children of each point
  // Per point: its joint in the clip; the joint that turns its bone.
  std::vector<int> joint, turner;
};

/// Builds the skeleton's joints and the plan. Fails if the parents are not a tree with one root.
Result<Plan> plan_of(const PointBody& body, Skeleton& skeleton) {
  Plan plan;
  const std::size_t points = body.parents.size();
  plan.children.resize(points);
  plan.joint.assign(points, -1);
  plan.turner.assign(points, -1);
  for (std::size_t j = 0; j < points; ++j) {
    if (body.parents[j] < 0)
      plan.order.push_back(j);
    else
      plan.children[static_cast<std::size_t>(body.parents[j])].push_back(j);
  }
  if (plan.order.size() != 1) {
    return Failure(
        Error{"", 0, "joints that hang on one root", std::to_string(plan.order.size()) + " roots"});
  }
  const auto add = [&](const std::string& name, int parent) {
    skeleton.joint_names.push_back(name);
    skeleton.parents.push_back(parent);
    skeleton.rest_offsets.push_back(Vec3::Zero());
    return static_cast<int>(skeleton.parents.size()) - 1;
  };
  plan.joint[plan.order[0]] = add(body.names[plan.order[0]], -1);
  // `order` grows while it is read, so this walks the tree level by level. Points in a circle are
  // never reached.
  for (std::size_t i = 0; i < plan.order.size(); ++i) {
    const std::size_t p = plan.order[i];
    for (const std::size_t j : plan.children[p]) {
      const bool alone = plan.children[p].size() == 1;
      plan.turner[j] = alone ? plan.joint[p] : add(body.names[j] + "Root", plan.joint[p]);
      plan.joint[j] = add(body.names[j], plan.turner[j]);
      plan.order.push_back(j);
    }
  }
  if (plan.order.size() != points) return Failure(Error{"", 0, "joints in a tree", "a circle"});
  return plan;
}

/// The rest direction to each joint from its parent. If it is not known, the direction of a known
/// joint below is used (for a clavicle), else the direction of the parent (for a finger).
std::vector<Vec3> rest_ways(const PointBody& body, const Plan& plan) {
  const auto names = kinect_names(body.names);
  std::vector<std::optional<Vec3>> ways;
  ways.reserve(names.size());
  for (const std::string& name : names) ways.push_back(known_direction(name));
  // Children come before parents here: a joint without a direction gets that of the joint below it.
  for (std::size_t i = plan.order.size(); i-- > 1;) {
    const auto p = static_cast<std::size_t>(body.parents[plan.order[i]]);
    if (!ways[p]) ways[p] = ways[plan.order[i]];
  }
  std::vector<Vec3> out(names.size(), Vec3::UnitY());
  for (const std::size_t j : plan.order) {
    const int parent = body.parents[j];
    if (ways[j]) {
      out[j] = *ways[j];
    } else if (parent >= 0) {
      out[j] = out[static_cast<std::size_t>(parent)];
    }
  }
  return out;
}

/// The rotation that best turns the rest directions of a joint's children to their current
/// directions. With one child it is the smallest rotation from `before`.
/// With several children it is the least-squares rotation (Kabsch): the singular vectors of the sum
/// of outer products, with the sign that excludes a reflection.
Quat turn_of(const std::vector<Vec3>& rest, const std::vector<Vec3>& now, const Quat& before) {
  if (rest.size() < 2) {
    return rest.empty() ? before : Quat::FromTwoVectors(before * rest[0], now[0]) * before;
  }
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < rest.size(); ++i) cross += now[i] * rest[i].transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sides = Eigen::Matrix3d::Identity();
  sides(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  return Quat(svd.matrixU() * sides * svd.matrixV().transpose());
}

/// Appends frames to a clip. set_lengths() is called first.
/// `global_` holds the global rotation of each joint of the clip in the current frame. `clip_` and
/// `plan_` belong to the caller.
class Poser {
 public:
  Poser(const PointBody& body, const Plan& plan, Clip& clip)
      : body_(body),
        plan_(plan),
        rest_(rest_ways(body, plan)),
        clip_(clip),
        global_(clip.skeleton.joints()) {}

  /// One frame is enough: callers pass joints whose bones have constant lengths.
  void set_lengths(const float* frame) {
    for (std::size_t j = 0; j < body_.parents.size(); ++j) {
      if (body_.parents[j] < 0) continue;
      const auto p = static_cast<std::size_t>(body_.parents[j]);
      clip_.skeleton.rest_offsets[static_cast<std::size_t>(plan_.joint[j])] =
          rest_[j] * (at(frame, j) - at(frame, p)).norm();
    }
  }

  /// Adds one frame: finds all global rotations and stores them relative to their parents.
  void append(const float* frame, Time stamp) {
    const Skeleton& skeleton = clip_.skeleton;
    const std::size_t joints = skeleton.joints(), t = clip_.frames.size();
    clip_.frames.stamps.push_back(stamp);
    clip_.frames.local_positions.resize((t + 1) * joints * 3);
    clip_.frames.local_rotations.resize((t + 1) * joints * 4);
    turn_all(frame);
    for (std::size_t i = 0; i < joints; ++i) {
      const bool is_root = skeleton.parents[i] < 0;
      vec3(clip_.frames.local_positions, t * joints + i) =
          is_root ? at(frame, plan_.order[0]) : skeleton.rest_offsets[i];
      const Quat parent =
          is_root ? Quat::Identity() : global_[static_cast<std::size_t>(skeleton.parents[i])];
      put_quat(clip_.frames.local_rotations, t * joints + i,
               (parent.conjugate() * global_[i]).normalized());
    }
  }

 private:
  static Vec3 at(const float* frame, std::size_t j) {
    return {frame[3 * j], frame[3 * j + 1], frame[3 * j + 2]};
  }

  Vec3 direction(const float* frame, std::size_t from, std::size_t to) const {
    const Vec3 way = at(frame, to) - at(frame, from);
    // Two joints at one place have no direction. The rest direction is used, so the rotation stays
    // finite.
    const double length = way.norm();
    return length > 1e-9 ? Vec3(way / length) : rest_[to];
  }

  /// Finds the global rotation of every joint, from the root outward.
  void turn_all(const float* frame) {
    for (const std::size_t p : plan_.order) {
      const auto own = static_cast<std::size_t>(plan_.joint[p]);
      const int above = clip_.skeleton.parents[own];
      const Quat before = above < 0 ? Quat::Identity() : global_[static_cast<std::size_t>(above)];
      std::vector<Vec3> rest, now;
      for (const std::size_t j : plan_.children[p]) {
        rest.push_back(rest_[j]);
        now.push_back(direction(frame, p, j));
      }
      global_[own] = turn_of(rest, now, before);
      for (std::size_t i = 0; i < rest.size() && rest.size() > 1; ++i) {
        const auto turner = static_cast<std::size_t>(plan_.turner[plan_.children[p][i]]);
        global_[turner] = Quat::FromTwoVectors(global_[own] * rest[i], now[i]) * global_[own];
      }
    }
  }

  const PointBody& body_;
  const Plan& plan_;
  std::vector<Vec3> rest_;  // rest direction of each point
  Clip& clip_;
  std::vector<Quat> global_;
};

}  // namespace

Result<Clip> skeleton_of_points(const PointBody& body, std::span<const float> positions, Time start,
                                double rate_hz) {
  Clip clip;
  const Plan plan = KA_TRY(plan_of(body, clip.skeleton));
  Poser poser(body, plan, clip);
  const std::size_t row = 3 * body.parents.size(), frames = positions.size() / row;
  if (frames > 0) poser.set_lengths(positions.data());
  for (std::size_t t = 0; t < frames; ++t) {
    poser.append(&positions[t * row], grid_stamp(start, rate_hz, t));
  }
  return clip;
}

}  // namespace kinalign
