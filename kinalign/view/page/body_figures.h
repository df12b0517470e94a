// SPDX-License-Identifier: Apache-2.0
// The data for one stream of joints on the page: the stored rows, the states of each joint, and the
// lengths of each bone.
#pragma once

#include "kinalign/motion/pose.h"
#include "kinalign/take/take.h"
#include "kinalign/view/page/take_page.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace kinalign {

/// A view of the joints in a slab, for skeletons and for points, which store validity in different
/// ways. The rows must outlive the view.
class JointRows {
 public:
  /// Makes the view. The result is absent for rows of nodes.
  static std::optional<JointRows> of(const std::variant<ClipRows, PointRows, ImuRows>& rows,
                                     std::size_t joints);
  Tracking state(std::size_t row, std::size_t joint) const;
  Vec3 at(std::size_t row, std::size_t joint) const {
    return vec3(*positions_, row * joints_ + joint);
  }
  std::size_t joints() const { return joints_; }

 private:
  const std::vector<double>* positions_ = nullptr;
  const std::vector<Tracking>* states_ = nullptr;     // set only for points
  const std::vector<std::uint8_t>* valid_ = nullptr;  // points [n,J]; skeleton [n] or empty
  std::size_t joints_ = 0;
};

/// Appends the x, y and z of a vector.
inline void put_vector(std::vector<float>& to, const Vec3& v) {
  for (const double x : {v.x(), v.y(), v.z()}) to.push_back(static_cast<float>(x));
}

/// Computes the pose of one row of a skeleton, in the space of its roots.
void pose_of_row(const Skeleton& skeleton, const ClipRows& rows, std::size_t row, GlobalPose& pose);

/// add() takes each row of the take in order. The take_...() functions move the results out at the
/// end. Counts and bone lengths use all rows; positions are stored only for rows with `keep`.
class BodyFigures {
 public:
  BodyFigures(const TakeGroup& group, std::size_t body);

  void add(const std::variant<ClipRows, PointRows, ImuRows>& rows, std::size_t row, bool keep);

  const PageBody& body() const { return body_; }
  std::size_t joints() const { return joints_; }
  PageBody take_body() { return std::move(body_); }
  JointStates take_states() { return std::move(states_); }
  /// Returns the bones that were seen in at least two rows; none for a skeleton stream.
  std::vector<BoneLength> bones() const;

 private:
  // Only sums are stored, so memory does not grow with the take.
  struct Sums {
    std::uint64_t rows = 0;
    // Lengths in m; squares: sum of squared deviations (Welford).
    double mean = 0.0, squares = 0.0, shortest = 0.0, longest = 0.0;
  };
  void add_bones(const JointRows& rows, std::size_t row);
  void keep_row(const JointRows& joints, const std::variant<ClipRows, PointRows, ImuRows>& rows,
                std::size_t row);

  std::size_t number_;      // index of the body
  std::size_t joints_ = 0;  // number of joints, without end sites
  std::optional<Skeleton> skeleton_;
  std::vector<EndSite> ends_;
  GlobalPose pose_;
  PageBody body_;
  JointStates states_;
  std::vector<Sums> bones_;  // [J]
};

}  // namespace kinalign
