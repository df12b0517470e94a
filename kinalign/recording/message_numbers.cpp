// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/message_numbers.h"

#include <iterator>

namespace kinalign {

/// Adds a number to the range before it, or makes a new range. If two ranges now touch, they are
/// joined.
void MessageNumbers::add(const McapMessage& message) {
  Ranges& ranges = channels_[message.channel];
  const std::uint32_t number = message.sequence;
  const auto after = ranges.upper_bound(number);
  auto at = after;
  // The number is in the range before it, or directly at the end of that range.
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
  // `from` may be one more than the largest number.
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

/// Counts numbers in gaps. Messages lost before the first or after the last number are not known.
std::uint64_t MessageNumbers::missing(std::uint16_t channel) const {
  std::uint64_t missing = 0;
  std::optional<std::uint64_t> end;  // one more than the last number of the previous range
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

/// The ranges of a channel. For a channel without messages, a shared empty map is returned.
const MessageNumbers::Ranges& MessageNumbers::ranges_of(std::uint16_t channel) const {
  static const Ranges none;
  const auto found = channels_.find(channel);
  return found == channels_.end() ? none : found->second;
}

}  // namespace kinalign
