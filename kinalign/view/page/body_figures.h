// SPDX-License-Identifier: Apache-2.0
// The figures of one stream of joints for the page: the stored rows, the states of each joint, and
// the lengths of each bone.
#pragma once

#include "kinalign/motion/pose.h"
#include "kinalign/take/take.h"
#include "kinalign/view/page/take_page.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace kinalign {

/// The rows of joints in a slab, for skeletons and for points.
/// A view: the rows must live longer. It hides how skeletons and points store validity.
class JointRows {
 public:
  /// Absent for rows of nodes.
  static std::optional<JointRows> of(const std::variant<ClipRows, PointRows, ImuRows>& rows,
                                     std::size_t joints);
  Tracking state(std::size_t row, std::size_t joint) const;
  Vec3 at(std::size_t row, std::size_t joint) const {
    return vec3(*positions_, row * joints_ + joint);
  }
  std::size_t joints() const { return joints_; }

 private:
  const std::vector<double>* positions_ = nullptr;
  const std::vector<Tracking>* states_ = nullptr;     // only for points
  const std::vector<std::uint8_t>* valid_ = nullptr;  // points [n,J]; clip [n] or empty
  std::size_t joints_ = 0;
};

/// Appends x, y and z.
inline void put_vector(std::vector<float>& to, const Vec3& v) {
  for (const double x : {v.x(), v.y(), v.z()}) to.push_back(static_cast<float>(x));
}

/// The pose of one row of a clip, in the space of its roots.
void pose_of_row(const Skeleton& skeleton, const ClipRows& rows, std::size_t row, GlobalPose& pose);

/// add() takes each row of the take in order; the take_...() functions move the results out at the
/// end. Counts and bones use all rows; positions only the rows with `keep`.
class BodyFigures {
 public:
  BodyFigures(const TakeGroup& group, std::size_t body);

  void add(const std::variant<ClipRows, PointRows, ImuRows>& rows, std::size_t row, bool keep);

  const PageBody& body() const { return body_; }
  std::size_t joints() const { return joints_; }
  PageBody take_body() { return std::move(body_); }
  JointStates take_states() { return std::move(states_); }
  /// The bones that were seen in at least two rows; none for a clip.
  std::vector<BoneLength> bones() const;

 private:
  // Only sums are kept, so memory does not grow with the take.
  struct Sums {
    std::uint64_t rows = 0;
    double mean = 0.0, squares = 0.0, shortest = 0.0, longest = 0.0;  // m; squares: Welford's sum
  };
  void add_bones(const JointRows& rows, std::size_t row);
  void keep_row(const JointRows& joints, const std::variant<ClipRows, PointRows, ImuRows>& rows,
                std::size_t row);

  std::size_t number_;
  std::size_t joints_ = 0;  // without end sites
  std::optional<Skeleton> skeleton_;
  std::vector<EndSite> ends_;
  GlobalPose pose_;
  PageBody body_;
  JointStates states_;
  std::vector<Sums> bones_;  // [J]
};

}  // namespace kinalign
