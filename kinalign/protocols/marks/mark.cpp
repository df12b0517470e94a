// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/marks/mark.h"

#include "kinalign/core/utf8.h"

#include <algorithm>
#include <array>

namespace kinalign {

const char* name_of(Mark::Kind kind) {
  static constexpr std::array<const char*, mark_kinds> names{"start", "stop", "t_pose", "text"};
  return names[static_cast<std::size_t>(kind)];
}

std::optional<Mark::Kind> mark_kind_named(std::string_view name) {
  for (std::size_t i = 0; i < mark_kinds; ++i) {
    const auto kind = static_cast<Mark::Kind>(i);
    if (name == name_of(kind)) return kind;
  }
  return std::nullopt;
}

// Messages and the console show texts of other programs. Control characters could change the
// display.
bool is_mark_text(std::string_view text) {
  const auto harmless = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte >= 0x20 && byte != 0x7f) || c == '\t' || c == '\n' || c == '\r';
  };
  return std::all_of(text.begin(), text.end(), harmless) && is_utf8(text);
}

bool MarkRepeats::is_repeat(const Mark& mark, HostTime now) {
  // Old ids and ids beyond the limit are removed, oldest first, so that memory is limited.
  while (!seen_.empty() && (seen_.size() > remembered || now - seen_.front().at > for_so_long_)) {
    ids_.erase(seen_.front().id);
    seen_.pop_front();
  }
  if (mark.id.empty()) return false;
  if (!ids_.insert(mark.id).second) return true;
  seen_.push_back({mark.id, now});
  return false;
}

}  // namespace kinalign
