// SPDX-License-Identifier: Apache-2.0
// From a take's rows to what its page shows, in one pass slab by slab. Memory grows with the rows
// that the page keeps, never with the take's length.
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
  /// The page keeps at most so many numbers of all bodies and nodes together: every stride-th row.
  /// 4.5 million make a page of less than 6 MB, measured on ten minutes of the demo.
  std::uint64_t most_numbers = 4'500'000;
  double detail_begin_s = 0.0;  // of the detail, from the first row
  double detail_length_s = 60.0;
  std::size_t bins = 240;  // of each lane at most; a short take has one for two rows
  std::vector<RawPoints> raw{};
  std::vector<RawNode> raw_nodes{};
  std::size_t most_raw_node_samples = 40'000;  // of all nodes together: 0.3 MB
};

/// Every stride-th row is kept so that the page stays small; 1: all are.
std::uint64_t page_stride(const TakeHeader& header, std::uint64_t most_numbers);

class TakeFigures {
 public:
  /// `header` and `report` are copied.
  TakeFigures(const TakeHeader& header, const AlignmentReport& report, TakeFigureOptions options);
  TakeFigures(TakeFigures&&) noexcept;
  TakeFigures& operator=(TakeFigures&&) noexcept;
  TakeFigures(const TakeFigures&) = delete;
  TakeFigures& operator=(const TakeFigures&) = delete;
  ~TakeFigures();

  /// The next rows of all groups, in order.
  void add(const TakeSlab& slab);
  /// After the last slab; the figures are used up.
  TakePage finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The longest stretch of rows in which some stream of points has nothing valid, slab by slab: what
/// a long take's detail is put around.
class LongestGap {
 public:
  void add(const TakeSlab& slab);
  /// Seconds from the first row to its middle; absent where there is none.
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
