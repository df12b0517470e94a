// SPDX-License-Identifier: Apache-2.0
// Learns the usual behaviour of a sender of Noitom's frames. A frame in several datagrams is
// accepted only if it follows that behaviour. The rules: docs/formats/noitom_stream.md, "Frames in
// several datagrams".
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace kinalign {

/// The usual value of a property. A different value becomes the usual one when it occurs twice in a
/// row. The first value is the usual one at once.
template <class Value>
class Habit {
 public:
  /// Takes the next value; true if it is the usual one.
  bool agrees(const Value& seen) {
    if (!usual_ || lately_ == seen) usual_ = seen;
    lately_ = seen;
    return usual_ == seen;
  }

 private:
  std::optional<Value> usual_, lately_;
};

/// The difference between a numbered header and the next one.
struct NoitomStep {
  /// Avatar and frame index of the next header minus this one's.
  std::uint32_t avatar = 0, index = 1;
  bool operator==(const NoitomStep&) const = default;
};

/// The latest steps from the headers of one avatar to the next headers. If a frame is missing, its
/// step and the one before appear as a single step.
class NoitomSteps {
 public:
  /// Adds a step; absent: a step within which a frame is or may be missing.
  void push(std::optional<NoitomStep> step);
  /// True if the step occurs often.
  bool is_usual(const NoitomStep& step) const;
  /// True if no frame is missing within the step: it occurs often and is not the sum of other
  /// steps.
  bool is_whole(const NoitomStep& step) const;
  /// True if the steps form a repeating pattern and this step continues it.
  bool repeat_with(const NoitomStep& step) const;

 private:
  bool is_sum(const NoitomStep& step) const;
  bool changes_avatar() const;

  std::deque<std::optional<NoitomStep>> lately_;
};

/// Delays within and between the frames of one sender.
class NoitomPace {
 public:
  /// Adds a frame: the delay from its first piece to its last, and to the next header.
  void push(Duration spread, Duration to_next);
  /// True if a piece that arrives `spread` after a header belongs to that header and not to the
  /// next one.
  bool is_in_time(Duration spread) const;
  /// True if the piece can't be the end of the next frame, because frames don't arrive in bursts.
  bool tells_apart(Duration spread) const;

 private:
  std::deque<Duration> spreads_, periods_;
};

}  // namespace kinalign
