// SPDX-License-Identifier: Apache-2.0
// Streams over time, in equal bins of a take: the share of measured samples, the time to raw
// samples, and the time interval of stamps. One line of the figure is a lane.
#pragma once

#include "kinalign/take/take.h"
#include "kinalign/view/page/take_page.h"

#include <cstddef>
#include <vector>

namespace kinalign {

/// The lanes of one group. A skeleton or points have one lane, with the share of their joints.
/// Nodes have one lane each, since each node may fail independently.
class LaneFigures {
 public:
  LaneFigures(const TakeGroup& group, std::size_t bins);

  void add(const std::variant<ClipRows, PointRows, ImuRows>& rows, std::size_t row,
           std::size_t bin);
  std::vector<PageLane> finish();

 private:
  struct Counts {
    std::uint64_t all = 0, tracked = 0, inferred = 0;
  };
  void add_distance(const SampleDistance& distance, std::size_t sample, std::size_t lane,
                    std::size_t bin);

  std::size_t joints_ = 0;  // number of joints of the body
  std::vector<PageLane> lanes_;
  std::vector<std::vector<Counts>> counts_;  // [lanes][bins]
};

}  // namespace kinalign
