// SPDX-License-Identifier: Apache-2.0
// What a sender of Noitom's frames always does, as far as it was seen: a frame in several datagrams
// is believed where it is as usual. The rules: docs/formats/noitom_stream.md, "Frames in several
// datagrams".
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace kinalign {

/// What is always the same, until it is another way twice running. The first one is as usual.
template <class Value>
class Habit {
 public:
  /// Whether it is as usual.
  bool agrees(const Value& seen) {
    if (!usual_ || lately_ == seen) usual_ = seen;
    lately_ = seen;
    return usual_ == seen;
  }

 private:
  std::optional<Value> usual_, lately_;
};

/// From a numbered header to the next one's.
struct NoitomStep {
  std::uint32_t avatar = 0, index = 1;  // how much more
  bool operator==(const NoitomStep&) const = default;
};

/// The last steps from one avatar's headers. Where a frame is missing, its step and the one before
/// are seen as one.
class NoitomSteps {
 public:
  /// Absent: a step that something is or may be missing in.
  void push(std::optional<NoitomStep> step);
  /// It comes often.
  bool is_usual(const NoitomStep& step) const;
  /// Nothing is missing in it: it comes often and is no sum of others.
  bool is_whole(const NoitomStep& step) const;
  /// The steps repeat themselves, and it is the next of them.
  bool repeat_with(const NoitomStep& step) const;

 private:
  bool is_sum(const NoitomStep& step) const;
  bool changes_avatar() const;

  std::deque<std::optional<NoitomStep>> lately_;
};

/// How a sender's frames and their pieces came one behind another.
class NoitomPace {
 public:
  /// Of a frame: from its first piece to its last, and to the next header.
  void push(Duration spread, Duration to_next);
  /// What came so much later than a header belongs to it rather than to the next one.
  bool is_in_time(Duration spread) const;
  /// It is surely not the next frame's end: frames do not come in bunches.
  bool tells_apart(Duration spread) const;

 private:
  std::deque<Duration> spreads_, periods_;
};

}  // namespace kinalign
