// SPDX-License-Identifier: Apache-2.0
// Makes the content of a take's page from its rows, in one pass over the slabs. Memory grows with
// the rows that the page stores, not with the take's length.
#pragma once

#include "kinalign/take/take.h"
#include "kinalign/view/page/detail_figures.h"
#include "kinalign/view/page/take_page.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

struct TakeFigureOptions {
  /// The greatest number of values that the page stores for all bodies and nodes together. To keep
  /// this limit, it stores every stride-th row. 4.5 million values give a page of less than 6 MB,
  /// measured on ten minutes of the demo.
  std::uint64_t most_numbers = 4'500'000;
  double detail_begin_s = 0.0;  // begin of the detail, s from the first row
  double detail_length_s = 60.0;
  std::size_t bins = 240;  // greatest number of bins; a short take has one bin for two rows
  std::vector<RawPoints> raw{};
  std::vector<RawNode> raw_nodes{};
  std::size_t most_raw_node_samples = 40'000;  // limit for all nodes together (0.3 MB)
};

/// Returns the stride: every stride-th row is stored, so that the page stays small. 1: all rows.
std::uint64_t page_stride(const TakeHeader& header, std::uint64_t most_numbers);

/// The constructor plans all figures from header and report. add() collects the rows, and finish()
/// returns the page.
class TakeFigures {
 public:
  /// `header` and `report` are copied.
  TakeFigures(const TakeHeader& header, const AlignmentReport& report, TakeFigureOptions options);
  TakeFigures(TakeFigures&&) noexcept;
  TakeFigures& operator=(TakeFigures&&) noexcept;
  TakeFigures(const TakeFigures&) = delete;
  TakeFigures& operator=(const TakeFigures&) = delete;
  ~TakeFigures();

  /// Adds the next rows of all groups, in order.
  void add(const TakeSlab& slab);
  /// Call after the last slab. Moves the figures out.
  TakePage finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Finds the longest time in which a stream of points has no valid point. The detail of a long take
/// is placed around it. This needs a separate pass before TakeFigures, since TakeFigures must know
/// the detail's position.
class LongestGap {
 public:
  void add(const TakeSlab& slab);
  /// Returns the seconds from the first row to the middle of that time; absent if there is none.
  std::optional<double> middle_s() const;

 private:
  struct DetailStretch {
    Time begin{}, end{};
    bool open = false;
  };
  std::optional<Time> first_;
  std::vector<DetailStretch> now_;  // [groups]
  DetailStretch longest_;
};

}  // namespace kinalign
