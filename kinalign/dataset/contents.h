// SPDX-License-Identifier: Apache-2.0
// Rules for the rows of a take, whichever program made it. They are checked slab by slab.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// Checks a take's rows in their order. Findings: stamps that do not rise; more than one step in a
/// hundred that differs from the step of the rate; numbers of valid cells that are not finite;
/// rotations whose length is not 1; bones of a skeleton that change by more than 2 cm and 5 %;
/// positions beyond 100 m; accelerations beyond 1000 m/s2; angular velocities beyond 100 rad/s. The
/// limits are our choice: a suit that keeps the feet on the floor stretches its legs by a
/// centimetre.
class ContentCheck {
 public:
  ContentCheck(const TakeHeader& header, double rate_hz);

  void add(const TakeSlab& slab);
  /// `file`: the take, for messages.
  Findings findings(const std::string& file) const;

 private:
  /// The counts of one group.
  struct Group {
    std::string name;
    std::vector<int> parents;         // only for a skeleton
    std::vector<double> least, most;  // [J] m, each bone, by the joint's local position
    std::vector<double> global_least, global_most;  // the same by the positions of both joints
    std::uint64_t not_finite = 0, not_unit = 0, far = 0, fast = 0;  // counts of cells
  };
  static void add_bone(const ClipRows& rows, std::size_t cell, std::size_t parent_cell,
                       std::size_t joint, Group& group);
  /// Checks one vector of an array that may be empty. The vector's cell is valid.
  static void add_vector(const std::vector<double>& all, std::size_t cell, double most,
                         Group& group);
  void add_stamps(const std::vector<Time>& stamps);
  void add_rows(const ClipRows& rows, std::size_t count, Group& group) const;
  void add_rows(const PointRows& rows, std::size_t count, Group& group) const;
  void add_rows(const ImuRows& rows, std::size_t count, Group& group) const;

  // If this is 0, the rate is not known and steps are not checked.
  double step_ns_;
  std::vector<Group> groups_;
  std::uint64_t steps_ = 0, uneven_ = 0, not_rising_ = 0;
  // The last stamp of the slab before; INT64_MIN before the first one.
  std::int64_t last_ns_ = INT64_MIN;
};

}  // namespace kinalign
