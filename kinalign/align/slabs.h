// SPDX-License-Identifier: Apache-2.0
// Makes the rows of a take in slabs: the reference unchanged, every other stream resampled onto it.
#pragma once

#include "kinalign/align/plan.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace kinalign {

/// Most rows of a slab: enough that the overlap of windows costs little, and few enough for the
/// second-level cache.
constexpr std::size_t slab_rows = 2048;
/// A slab has fewer rows if the rows of a take are long: about this many bytes at most.
constexpr std::size_t slab_bytes = std::size_t{16} << 20;
/// Longest slab, for any rate of the reference, because the other streams' samples of a slab are in
/// memory.
constexpr std::int64_t longest_slab_ns = 120'000'000'000;

/// One pass over the streams of a take. It keeps the place of each stream: a call continues where
/// the last one ended, and the samples that later rows need stay in windows.
class SlabMaker {
 public:
  /// Starts a pass over the streams of the groups marked in `groups` (in the order of the header;
  /// the reference is always included). `recording` and `plan` must live longer.
  static Result<SlabMaker> start(const Recording& recording, const AlignPlan& plan,
                                 const std::vector<bool>& groups);
  SlabMaker(SlabMaker&&) noexcept;
  SlabMaker& operator=(SlabMaker&&) noexcept;
  SlabMaker(const SlabMaker&) = delete;
  SlabMaker& operator=(const SlabMaker&) = delete;
  ~SlabMaker();

  /// Calls `use` with each slab of at most slab_rows rows, in order. Groups that are not included
  /// have empty rows. Points are still in their own space. With two jobs the reference is read one
  /// slab ahead.
  Result<void> for_each(std::size_t jobs, const std::function<Result<void>(TakeSlab&)>& use);

  /// Continues reading to the end of the take. Streams that report findings only after their last
  /// row are read to their end.
  Result<void> read_rest(const std::function<Result<void>()>& go);

  /// The content that the grid can't carry, for a stream (index in the recording), so far.
  ResampleCount content(std::size_t stream) const;
  /// The counts of a stream so far.
  StreamCounts counts(std::size_t stream) const;

 private:
  struct State;
  explicit SlabMaker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
