// SPDX-License-Identifier: Apache-2.0
// Rows that wait until their stamps are settled (io/row_stamps.h).
#pragma once

#include "kinalign/io/row_stamps.h"
#include "kinalign/motion/streams.h"

#include <vector>

namespace kinalign {

template <class T>
void move_behind(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
  from.clear();
}

inline void move_behind(PointFrames& from, PointFrames& to) {
  move_behind(from.stamps, to.stamps);
  move_behind(from.positions, to.positions);
  move_behind(from.state, to.state);
}

inline void move_behind(ImuSamples& from, ImuSamples& to) {
  move_behind(from.stamps, to.stamps);
  move_behind(from.orientation, to.orientation);
  move_behind(from.acceleration, to.acceleration);
  move_behind(from.angular_velocity, to.angular_velocity);
  move_behind(from.valid, to.valid);
}

template <class Frames>
class HeldRows {
 public:
  /// Where the next row goes.
  Frames& target(const RowStamps& stamps, Frames& out) { return stamps.settled() ? out : held_; }

  /// After each row, and at the end: lets the rows go once their stamps are final.
  void release(const RowStamps& stamps, Frames& out) {
    if (held_.stamps.empty() || !stamps.settled()) return;
    stamps.restamp(held_.stamps);
    move_behind(held_, out);
  }

 private:
  Frames held_;
};

}  // namespace kinalign
