// SPDX-License-Identifier: Apache-2.0
// Keeps rows until their stamps are final (formats/row_stamps.h).
#pragma once

#include "kinalign/formats/row_stamps.h"
#include "kinalign/motion/frame_arrays.h"

namespace kinalign {

/// The stamps of the first rows may depend on later rows. This class keeps the first rows until
/// their stamps are final.
template <class Frames>
class HeldRows {
 public:
  /// The rows to append to: `out` if the stamps are final, else the rows that are kept here.
  Frames& target(const RowStamps& stamps, Frames& out) { return stamps.settled() ? out : held_; }

  /// Call this after each row and at the end. If the stamps are final, it moves the kept rows to
  /// `out`.
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
