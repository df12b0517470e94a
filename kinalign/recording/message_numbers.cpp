// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/message_numbers.h"

#include <iterator>

namespace kinalign {

/// Extends the range before the number or makes a new one. If the gap to the next range is closed,
/// both become one.
void MessageNumbers::add(const McapMessage& message) {
  Ranges& ranges = channels_[message.channel];
  const std::uint32_t number = message.sequence;
  const auto after = ranges.upper_bound(number);
  auto at = after;
  // The number lies in the range before or directly at its end.
  if (after != ranges.begin() && std::prev(after)->second >= number) {
    --at;
    if (at->second == number) ++at->second;
  } else {
    at = ranges.emplace_hint(after, number, std::uint64_t{number} + 1);
  }
  if (after != ranges.end() && after->first == at->second) {
    at->second = after->second;
    ranges.erase(after);
  }
}

bool MessageNumbers::has(const McapMessage& message) const {
  return next(message.channel, message.sequence) == message.sequence;
}

std::optional<std::uint32_t> MessageNumbers::next(std::uint16_t channel, std::uint64_t from) const {
  // The caller may ask for one more than the largest number.
  if (from > UINT32_MAX) return std::nullopt;
  const auto number = static_cast<std::uint32_t>(from);
  const Ranges& ranges = ranges_of(channel);
  const auto after = ranges.upper_bound(number);
  if (after != ranges.begin() && std::prev(after)->second > number) return number;
  return after == ranges.end() ? std::nullopt : std::optional(after->first);
}

std::optional<std::uint32_t> MessageNumbers::last(std::uint16_t channel) const {
  const Ranges& ranges = ranges_of(channel);
  if (ranges.empty()) return std::nullopt;
  return static_cast<std::uint32_t>(ranges.rbegin()->second - 1);
}

/// Only gaps between numbers count. Messages lost before the first or after the last one can't be
/// known.
std::uint64_t MessageNumbers::missing(std::uint16_t channel) const {
  std::uint64_t missing = 0;
  std::optional<std::uint64_t> end;  // of the range before
  for (const auto& [first, after_last] : ranges_of(channel)) {
    missing += first - end.value_or(first);
    end = after_last;
  }
  return missing;
}

std::uint64_t MessageNumbers::missing() const {
  std::uint64_t all = 0;
  for (const auto& [channel, ranges] : channels_) all += missing(channel);
  return all;
}

/// A channel without messages has no ranges; the empty set avoids an entry for it.
const MessageNumbers::Ranges& MessageNumbers::ranges_of(std::uint16_t channel) const {
  static const Ranges none;
  const auto found = channels_.find(channel);
  return found == channels_.end() ? none : found->second;
}

}  // namespace kinalign
