// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/body_figures.h"

#include "kinalign/motion/kinect_joints.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

/// Shorter end sites are fingertips, which are too small to be visible.
constexpr double shortest_end_m = 0.04;

/// Returns the parents of a Kinect's joints. The parent is -1 for all other points, because their
/// bones are not known, and for a joint whose parent is not in the stream.
std::vector<int> point_parents(const std::vector<std::string>& names) {
  std::vector<int> parents(names.size(), -1);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const auto known = std::find(kinect_joints.begin(), kinect_joints.end(), names[j]);
    if (known == kinect_joints.end()) continue;
    const std::size_t k = kinect_parents[static_cast<std::size_t>(known - kinect_joints.begin())];
    const auto parent = std::find(names.begin(), names.end(), kinect_joints[k]);
    const auto p = static_cast<int>(parent - names.begin());
    if (parent != names.end() && p != static_cast<int>(j)) parents[j] = p;
  }
  return parents;
}

}  // namespace

std::optional<JointRows> JointRows::of(const std::variant<ClipRows, PointRows, ImuRows>& rows,
                                       std::size_t joints) {
  JointRows out;
  out.joints_ = joints;
  if (const auto* clip = std::get_if<ClipRows>(&rows)) {
    out.positions_ = &clip->positions;
    out.valid_ = &clip->valid;
    return out;
  }
  const auto* points = std::get_if<PointRows>(&rows);
  if (points == nullptr) return std::nullopt;
  out.positions_ = &points->positions;
  out.states_ = &points->state;
  out.valid_ = &points->valid;
  return out;
}

Tracking JointRows::state(std::size_t row, std::size_t joint) const {
  const std::size_t cell = row * joints_ + joint;
  // A skeleton has one flag for a whole row; points have one flag for each joint.
  if (states_ == nullptr) {
    return valid_->empty() || (*valid_)[row] != 0 ? Tracking::tracked : Tracking::missing;
  }
  if (!valid_->empty() && (*valid_)[cell] == 0) return Tracking::missing;
  // A valid row between a missing and a tracked sample has the worse state of both. It is still not
  // missing.
  return std::max((*states_)[cell], Tracking::inferred);
}

// Allocates memory for a pose in each call. It is called only for stored rows and for nodes.
void pose_of_row(const Skeleton& skeleton, const ClipRows& rows, std::size_t row,
                 GlobalPose& pose) {
  const std::size_t joints = skeleton.joints();
  Pose local;
  for (std::size_t j = 0; j < joints; ++j) {
    local.local_positions.push_back(vec3(rows.local_positions, row * joints + j));
    local.local_rotations.push_back(quat(rows.local_rotations, row * joints + j));
  }
  forward_kinematics(skeleton, local, pose);
}

/// If the points have the bones of a Kinect, they get the Kinect's colour, otherwise that of mocap.
BodyFigures::BodyFigures(const TakeGroup& group, std::size_t body) : number_(body) {
  body_.name = group.name;
  body_.in_take_space = group.space == "take";
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) {
    body_.kind = PageKind::clip;
    body_.joint_names = clip->skeleton.joint_names;
    body_.parents = clip->skeleton.parents;
    for (const EndSite& end : clip->skeleton.end_sites) {
      if (end.offset.norm() < shortest_end_m) continue;
      ends_.push_back(end);
      body_.joint_names.push_back(clip->skeleton.joint_names[static_cast<std::size_t>(end.parent)] +
                                  " end");
      body_.parents.push_back(end.parent);
    }
    joints_ = clip->skeleton.joints();
    skeleton_ = clip->skeleton;
  } else {
    body_.kind = PageKind::points;
    body_.joint_names = std::get<PointGroup>(group.kind).joint_names;
    body_.parents = point_parents(body_.joint_names);
    const bool bones = std::any_of(body_.parents.begin(), body_.parents.end(),
                                   [](int parent) { return parent >= 0; });
    // If other streams were moved onto these points, take_figures.cpp makes them red later.
    body_.colour = bones ? PageColour::kinect : PageColour::mocap;
    joints_ = body_.joint_names.size();
    bones_.resize(joints_);
  }
  states_.body = body;
  states_.counts.resize(joints_);
}

void BodyFigures::add(const std::variant<ClipRows, PointRows, ImuRows>& rows, std::size_t row,
                      bool keep) {
  const auto joints = JointRows::of(rows, joints_);
  if (!joints) return;
  for (std::size_t j = 0; j < joints_; ++j) {
    ++states_.counts[j][static_cast<std::size_t>(joints->state(row, j))];
  }
  add_bones(*joints, row);
  if (keep) keep_row(*joints, rows, row);
}

/// Updates the lengths of the bones whose two ends are tracked (Welford's method).
void BodyFigures::add_bones(const JointRows& rows, std::size_t row) {
  for (std::size_t j = 0; j < bones_.size(); ++j) {
    const int parent = body_.parents[j];
    if (parent < 0) continue;
    const auto p = static_cast<std::size_t>(parent);
    if (rows.state(row, j) != Tracking::tracked || rows.state(row, p) != Tracking::tracked)
      continue;
    const double length = (rows.at(row, j) - rows.at(row, p)).norm();
    Sums& sums = bones_[j];
    if (sums.rows == 0) sums.shortest = sums.longest = length;
    ++sums.rows;
    const double off = length - sums.mean;
    sums.mean += off / static_cast<double>(sums.rows);
    sums.squares += off * (length - sums.mean);
    sums.shortest = std::min(sums.shortest, length);
    sums.longest = std::max(sums.longest, length);
  }
}

/// Stores a row for the page. The positions of end sites follow those of the joints. They are
/// computed from the pose and are missing unless all joints are tracked.
void BodyFigures::keep_row(const JointRows& joints,
                           const std::variant<ClipRows, PointRows, ImuRows>& rows,
                           std::size_t row) {
  bool all_tracked = true;
  for (std::size_t j = 0; j < joints_; ++j) {
    put_vector(body_.positions, joints.at(row, j));
    const Tracking state = joints.state(row, j);
    all_tracked = all_tracked && state == Tracking::tracked;
    body_.state.push_back(static_cast<std::uint8_t>(state));
  }
  if (ends_.empty()) return;
  const auto& clip = std::get<ClipRows>(rows);
  pose_of_row(*skeleton_, clip, row, pose_);
  // An end site is computed from the rotations, so it is visible if the whole row is valid.
  const auto state = all_tracked ? Tracking::tracked : Tracking::missing;
  for (const EndSite& end : ends_) {
    const auto j = static_cast<std::size_t>(end.parent);
    put_vector(body_.positions, joints.at(row, j) + pose_.rotations[j] * end.offset);
    body_.state.push_back(static_cast<std::uint8_t>(state));
  }
}

std::vector<BoneLength> BodyFigures::bones() const {
  std::vector<BoneLength> out;
  for (std::size_t j = 0; j < bones_.size(); ++j) {
    const Sums& sums = bones_[j];
    // A standard deviation needs two values.
    if (sums.rows < 2) continue;
    out.push_back({number_, j, sums.rows, sums.mean,
                   std::sqrt(sums.squares / static_cast<double>(sums.rows - 1)), sums.shortest,
                   sums.longest});
  }
  return out;
}

}  // namespace kinalign
