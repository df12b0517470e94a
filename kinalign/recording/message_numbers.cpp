// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/message_numbers.h"

#include <algorithm>

namespace kinalign {

/// Adds a range of numbers. Adjacent ranges are merged.
void MessageNumbers::add(Stretches& stretches, std::uint32_t begin, std::uint64_t end) {
  auto at = stretches.upper_bound(begin);
  if (at != stretches.begin() && std::prev(at)->second >= begin) {
    --at;
  } else {
    at = stretches.emplace_hint(at, begin, end);
  }
  at->second = std::max(at->second, end);
  for (auto next = std::next(at); next != stretches.end() && next->first <= at->second;) {
    at->second = std::max(at->second, next->second);
    next = stretches.erase(next);
  }
}

void MessageNumbers::add(const McapMessage& message) {
  add(channels_[message.channel], message.sequence, std::uint64_t{message.sequence} + 1);
}

void MessageNumbers::add_all(const MessageNumbers& others) {
  for (const std::uint16_t channel : others.channels()) add_all(others, channel);
}

void MessageNumbers::add_all(const MessageNumbers& others, std::uint16_t channel) {
  for (const auto& [begin, end] : others.of(channel)) add(channels_[channel], begin, end);
}

const MessageNumbers::Stretches& MessageNumbers::of(std::uint16_t channel) const {
  static const Stretches none;
  const auto found = channels_.find(channel);
  return found == channels_.end() ? none : found->second;
}

std::vector<std::uint16_t> MessageNumbers::channels() const {
  std::vector<std::uint16_t> ids;
  for (const auto& [id, stretches] : channels_) ids.push_back(id);
  return ids;
}

std::optional<std::uint32_t> MessageNumbers::next(std::uint16_t channel, std::uint64_t from) const {
  if (from > UINT32_MAX) return std::nullopt;
  const auto number = static_cast<std::uint32_t>(from);
  const Stretches& stretches = of(channel);
  const auto behind = stretches.upper_bound(number);
  if (behind != stretches.begin() && std::prev(behind)->second > from) return number;
  return behind == stretches.end() ? std::nullopt : std::optional(behind->first);
}

std::uint64_t MessageNumbers::present(std::uint16_t channel) const {
  std::uint64_t present = 0;
  for (const auto& [begin, end] : of(channel)) present += end - begin;
  return present;
}

std::uint64_t MessageNumbers::missing(std::uint16_t channel) const {
  const Stretches& stretches = of(channel);
  if (stretches.empty()) return 0;
  std::uint64_t missing = 0, behind = stretches.begin()->first;
  for (const auto& [begin, end] : stretches) {
    missing += begin - behind;
    behind = end;
  }
  return missing;
}

bool NumberGuard::believes(const McapMessage& message, bool unchecked) {
  const auto last = last_.find(message.channel);
  if (!unchecked) {
    proved_.add(message);
    const bool is_last = last == last_.end() || message.sequence > last->second.number;
    if (is_last) last_[message.channel] = {message.sequence, message.log_time};
    return true;
  }
  const auto first = proved_.next(message.channel, 0);
  bool is_believed = true;  // the result if no message of the channel was checked yet
  if (first && message.sequence > last->second.number) {
    const std::uint64_t since = message.log_time - std::min(message.log_time, last->second.at);
    const std::uint64_t most = 1024 + (since >> 14U);  // about 61,000 messages per second
    is_believed = message.sequence - last->second.number <= most;
  } else if (first) {
    is_believed = message.sequence > *first && !proved_.has(message);
  }
  strays_ += is_believed ? 0 : 1;
  return is_believed;
}

bool MessageNumbers::has(const Stretches& stretches, std::uint32_t begin, std::uint64_t end) {
  const auto next = stretches.upper_bound(begin);
  return next != stretches.begin() && std::prev(next)->second >= end;
}

bool MessageNumbers::has(const McapMessage& message) const {
  return has(of(message.channel), message.sequence, std::uint64_t{message.sequence} + 1);
}

bool MessageNumbers::has_all(const MessageNumbers& others) const {
  for (const auto& [id, stretches] : others.channels_) {
    for (const auto& [begin, end] : stretches) {
      if (!has(of(id), begin, end)) return false;
    }
  }
  return true;
}

bool MessageNumbers::goes_on_with(const MessageNumbers& others, std::uint16_t channel) const {
  const Stretches& own = of(channel);
  if (own.empty()) return false;
  const std::uint32_t first = own.begin()->first;
  for (const auto& [begin, end] : others.of(channel)) {
    if (end > first && !has(own, std::max(begin, first), end)) return false;
  }
  return true;
}

// Both lists are sorted, so one search per range suffices.
bool MessageNumbers::shares_with(const MessageNumbers& others, std::uint16_t channel) const {
  const Stretches& theirs = others.of(channel);
  for (const auto& [begin, end] : of(channel)) {
    if (end > UINT32_MAX) return !theirs.empty() && std::prev(theirs.end())->second > begin;
    const auto next = theirs.lower_bound(static_cast<std::uint32_t>(end));
    if (next != theirs.begin() && std::prev(next)->second > begin) return true;
  }
  return false;
}

}  // namespace kinalign
