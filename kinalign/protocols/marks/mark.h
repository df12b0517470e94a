// SPDX-License-Identifier: Apache-2.0
// A mark: an event that another program reports, for example a start or a stop.
// docs/formats/marks.md.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>

namespace kinalign {

/// A mark has the same meaning whichever program sent it. It has no stamp; the caller uses the
/// arrival time of the datagram.
struct Mark {
  enum class Kind : std::uint8_t { start, stop, t_pose, text };
  Kind kind = Kind::text;
  std::string text;
  std::optional<Duration> latency;  // time from the mark to its effect; for start and stop only
  std::string id;  // a repeated mark has the same id; without an id, repeats are not recognised

  bool operator==(const Mark&) const = default;
};
inline constexpr std::size_t mark_kinds = 4;
/// Limits for marks from other programs.
inline constexpr double most_latency_ms = 60'000.0;
inline constexpr std::size_t most_marks = 10'000;  // in a recording

/// The kind's name in calls and in the output of --json, for example "t_pose".
const char* name_of(Mark::Kind kind);
/// The kind with that name; empty if there is none.
std::optional<Mark::Kind> mark_kind_named(std::string_view name);

/// True if the text is UTF-8 and has no control characters except tabs and line ends.
bool is_mark_text(std::string_view text);

/// Recognises repeated marks. It remembers the last 1024 ids for a limited time.
class MarkRepeats {
 public:
  static constexpr std::size_t remembered = 1024;

  explicit MarkRepeats(Duration for_so_long) : for_so_long_(for_so_long) {}

  /// Returns true if a mark with this id arrived before, and remembers the id. The result is always
  /// false for a mark without an id. `now`: the arrival of the datagram.
  bool is_repeat(const Mark& mark, HostTime now);

 private:
  /// `seen_` and `ids_` contain the same ids. `seen_` keeps their age, and `ids_` makes the search
  /// fast.
  struct Seen {
    std::string id;
    HostTime at{};
  };
  Duration for_so_long_;
  std::deque<Seen> seen_;  // in the order of arrival
  std::unordered_set<std::string> ids_;
};

}  // namespace kinalign
