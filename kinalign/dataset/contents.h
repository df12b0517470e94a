// SPDX-License-Identifier: Apache-2.0
// Rules that the rows of every take must keep, whatever made them. They are checked slab by slab.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// Looks at a take's rows in their order. Findings say what is broken: stamps rise; one step in a
/// hundred at most is not the rate's; numbers of valid cells are finite and rotations have the
/// length 1; the bones of a skeleton change their length by 2 cm at most, or 5 %; positions lie
/// within 100 m, accelerations within 1000 m/s2, angular velocities within 100 rad/s. The limits
/// are chosen: a suit that keeps the feet on the floor stretches its legs by a centimetre.
class ContentCheck {
 public:
  ContentCheck(const TakeHeader& header, double rate_hz);

  void add(const TakeSlab& slab);
  /// `file`: the take, for messages.
  Findings findings(const std::string& file) const;

 private:
  /// Counts of one group.
  struct Group {
    std::string name;
    std::vector<int> parents;         // of a skeleton
    std::vector<double> least, most;  // [J] m, of each bone, by the joint's local place
    std::vector<double> global_least, global_most;  // the same by both joints' places
    std::uint64_t not_finite = 0, not_unit = 0, far = 0, fast = 0;  // cells
  };
  static void add_bone(const ClipRows& rows, std::size_t cell, std::size_t parent_cell,
                       std::size_t joint, Group& group);
  /// One of an array that may be absent, of a valid cell.
  static void add_vector(const std::vector<double>& all, std::size_t cell, double most,
                         Group& group);
  void add_stamps(const std::vector<Time>& stamps);
  void add_rows(const ClipRows& rows, std::size_t count, Group& group) const;
  void add_rows(const PointRows& rows, std::size_t count, Group& group) const;
  void add_rows(const ImuRows& rows, std::size_t count, Group& group) const;

  double step_ns_;
  std::vector<Group> groups_;
  std::uint64_t steps_ = 0, uneven_ = 0, not_rising_ = 0;
  std::int64_t last_ns_ = INT64_MIN;
};

}  // namespace kinalign
