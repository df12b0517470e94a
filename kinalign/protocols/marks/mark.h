// SPDX-License-Identifier: Apache-2.0
// That something happened, as other programs tell it: docs/formats/marks.md.
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

struct Mark {
  enum class Kind : std::uint8_t { start, stop, t_pose, text };
  Kind kind = Kind::text;
  std::string text;
  std::optional<Duration> latency;  // from the mark to its effect; of start and stop
  std::string id;                   // what it is known again by; empty: it never is

  bool operator==(const Mark&) const = default;
};
inline constexpr std::size_t mark_kinds = 4;
inline constexpr double most_latency_ms = 60'000.0;
inline constexpr std::size_t most_marks = 10'000;  // of a recording that are looked at

/// "t_pose", as in calls and --json.
const char* name_of(Mark::Kind kind);
/// Absent: no kind has that name.
std::optional<Mark::Kind> mark_kind_named(std::string_view name);

/// Whether a text holds no control characters but tabs and line ends, and is UTF-8.
bool is_mark_text(std::string_view text);

/// Which marks came already: the last 1024, and only for so long.
class MarkRepeats {
 public:
  static constexpr std::size_t remembered = 1024;

  explicit MarkRepeats(Duration for_so_long) : for_so_long_(for_so_long) {}

  /// Whether one of this id came; it did now. Never of one without.
  bool is_repeat(const Mark& mark, HostTime now);

 private:
  struct Seen {
    std::string id;
    HostTime at{};
  };
  Duration for_so_long_;
  std::deque<Seen> seen_;  // in the order of arrival
  std::unordered_set<std::string> ids_;
};

}  // namespace kinalign
