// SPDX-License-Identifier: Apache-2.0
// An event that another program reports: docs/formats/marks.md.
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

/// The meaning is the same whichever program sent it. It has no stamp: the caller uses the arrival
/// of the datagram.
struct Mark {
  enum class Kind : std::uint8_t { start, stop, t_pose, text };
  Kind kind = Kind::text;
  std::string text;
  std::optional<Duration> latency;  // time from the mark to its effect; only for start and stop
  std::string id;  // a repeated mark has the same id; empty: it can't be recognised

  bool operator==(const Mark&) const = default;
};
inline constexpr std::size_t mark_kinds = 4;
/// Limits of what is accepted from outside.
inline constexpr double most_latency_ms = 60'000.0;
inline constexpr std::size_t most_marks = 10'000;  // in a recording; more are not read

/// The kind's name in calls and --json: "t_pose".
const char* name_of(Mark::Kind kind);
/// The kind of that name; absent if there is none.
std::optional<Mark::Kind> mark_kind_named(std::string_view name);

/// True if the text is UTF-8 and has no control characters except tabs and line ends.
bool is_mark_text(std::string_view text);

/// Recognises repeated marks: remembers the last 1024 ids, for a limited time.
class MarkRepeats {
 public:
  static constexpr std::size_t remembered = 1024;

  explicit MarkRepeats(Duration for_so_long) : for_so_long_(for_so_long) {}

  /// True if a mark with this id arrived before; remembers the id. Always false without an id.
  /// `now` is the arrival of the datagram.
  bool is_repeat(const Mark& mark, HostTime now);

 private:
  /// `seen_` and `ids_` hold the same ids. `seen_` knows their age, `ids_` finds one quickly.
  struct Seen {
    std::string id;
    HostTime at{};
  };
  Duration for_so_long_;
  std::deque<Seen> seen_;  // in the order of arrival
  std::unordered_set<std::string> ids_;
};

}  // namespace kinalign
