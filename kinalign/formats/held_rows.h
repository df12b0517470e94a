// SPDX-License-Identifier: Apache-2.0
// Keeps rows until their stamps are settled (formats/row_stamps.h).
#pragma once

#include "kinalign/formats/row_stamps.h"
#include "kinalign/motion/frame_arrays.h"

namespace kinalign {

/// The stamps of the first rows may depend on later rows. Rows are held until then, at most as long
/// as the stamps are not settled.
template <class Frames>
class HeldRows {
 public:
  /// The place for the next row: `out` once the stamps are settled, before that the rows kept here.
  Frames& target(const RowStamps& stamps, Frames& out) { return stamps.settled() ? out : held_; }

  /// Call after each row and at the end. Moves the kept rows to `out` once their stamps are final.
  void release(const RowStamps& stamps, Frames& out) {
    if (held_.stamps.empty() || !stamps.settled()) return;
    stamps.restamp(held_.stamps);
    for_each_frame_array<Frames>([&](auto array) {
      auto& to = out.*array;
      to.insert(to.end(), (held_.*array).begin(), (held_.*array).end());
    });
    held_ = {};
  }

 private:
  Frames held_;
};

}  // namespace kinalign
