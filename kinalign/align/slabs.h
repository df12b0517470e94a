// SPDX-License-Identifier: Apache-2.0
// The rows of a take, slab by slab: the reference as it is, every other stream resampled onto it.
#pragma once

#include "kinalign/align/plan.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace kinalign {

/// Rows of a slab at most: enough for the windows' overlap to cost little, few enough for the
/// second cache.
constexpr std::size_t slab_rows = 2048;
/// Fewer where the rows of a take are longer than usual: no more than these, and some.
constexpr std::size_t slab_bytes = std::size_t{16} << 20;
/// And no longer than this, whatever the reference's rate: the other streams' samples of a slab
/// lie in memory.
constexpr std::int64_t longest_slab_ns = 120'000'000'000;

class SlabMaker {
 public:
  /// Starts a pass over the streams of the groups in `groups` (by number of the header; the
  /// reference is always in). Both arguments must outlive it.
  static Result<SlabMaker> start(const Recording& recording, const AlignPlan& plan,
                                 const std::vector<bool>& groups);
  SlabMaker(SlabMaker&&) noexcept;
  SlabMaker& operator=(SlabMaker&&) noexcept;
  SlabMaker(const SlabMaker&) = delete;
  SlabMaker& operator=(const SlabMaker&) = delete;
  ~SlabMaker();

  /// Calls `use` with each slab of at most slab_rows in turn. Groups left out have empty rows.
  /// Points are in their own space yet. With two jobs the reference is read one slab ahead.
  Result<void> for_each(std::size_t jobs, const std::function<Result<void>(TakeSlab&)>& use);

  /// Reads on to the take's end; streams that have findings only after their last row, to their
  /// end.
  Result<void> read_rest(const std::function<Result<void>()>& go);

  /// Of a stream, as in the recording, so far: what the grid can't carry, and what was counted.
  ResampleCount content(std::size_t stream) const;
  StreamCounts counts(std::size_t stream) const;

 private:
  struct State;
  explicit SlabMaker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
