// SPDX-License-Identifier: Apache-2.0
// Makes the rows of a take in blocks ("slabs"). The reference (the stream whose stamps are the
// grid) is copied, and every other stream is resampled to the reference's stamps.
#pragma once

#include "kinalign/align/plan.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace kinalign {

/// Most rows of a slab. With more rows, a slab would not fit into the second-level cache. With
/// fewer rows, samples near the ends of slabs would be processed twice too often.
constexpr std::size_t slab_rows = 2048;
/// Limit on the bytes of a slab. If rows are long, a slab has fewer rows.
constexpr std::size_t slab_bytes = std::size_t{16} << 20;
/// Longest time of a slab. All samples of the other streams within this time are in memory, so a
/// slow reference needs this limit.
constexpr std::int64_t longest_slab_ns = 120'000'000'000;

/// One pass over the streams of a take. Each call continues in each stream where the previous call
/// ended. Samples that later rows need are stored in windows.
class SlabMaker {
 public:
  /// Starts a pass over the groups marked in `groups` (in the order of the header; the reference is
  /// always included). `recording` and `plan` must outlive the object.
  static Result<SlabMaker> start(const Recording& recording, const AlignPlan& plan,
                                 const std::vector<bool>& groups);
  SlabMaker(SlabMaker&&) noexcept;
  SlabMaker& operator=(SlabMaker&&) noexcept;
  SlabMaker(const SlabMaker&) = delete;
  SlabMaker& operator=(const SlabMaker&) = delete;
  ~SlabMaker();

  /// Calls `use` with each slab, in order. A slab has at most slab_rows rows. Groups that are not
  /// included have empty rows. Points are still in their own space. With two jobs the reference is
  /// read one slab in advance.
  Result<void> for_each(std::size_t jobs, const std::function<Result<void>(TakeSlab&)>& use);

  /// Reads on to the end of the take's time span. Some streams have findings only after their last
  /// row, so these streams are read to their end.
  Result<void> read_rest(const std::function<Result<void>()>& go);

  /// Returns the motion of a stream that is too fast for the grid, so far. `stream`: index in the
  /// recording.
  ResampleCount content(std::size_t stream) const;
  /// Returns the counts of a stream so far.
  StreamCounts counts(std::size_t stream) const;

 private:
  struct State;
  explicit SlabMaker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
