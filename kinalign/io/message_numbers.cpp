// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/message_numbers.h"

#include <algorithm>

namespace kinalign {

/// Numbers that touch are one stretch.
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
  for (const auto& [id, stretches] : others.channels_) {
    for (const auto& [begin, end] : stretches) add(channels_[id], begin, end);
  }
}

std::uint64_t MessageNumbers::present(std::uint16_t channel) const {
  std::uint64_t present = 0;
  const auto found = channels_.find(channel);
  if (found == channels_.end()) return present;
  for (const auto& [begin, end] : found->second) present += end - begin;
  return present;
}

std::uint64_t MessageNumbers::missing(std::uint16_t channel) const {
  const auto found = channels_.find(channel);
  if (found == channels_.end() || found->second.empty()) return 0;
  std::uint64_t missing = 0, behind = found->second.begin()->first;
  for (const auto& [begin, end] : found->second) {
    missing += begin - behind;
    behind = end;
  }
  return missing;
}

bool MessageNumbers::has(const McapMessage& message) const {
  const auto channel = channels_.find(message.channel);
  if (channel == channels_.end()) return false;
  const auto next = channel->second.upper_bound(message.sequence);
  return next != channel->second.begin() && message.sequence < std::prev(next)->second;
}

bool MessageNumbers::has_all(const MessageNumbers& others) const {
  for (const auto& [id, stretches] : others.channels_) {
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) return false;
    for (const auto& [begin, end] : stretches) {
      const auto next = channel->second.upper_bound(begin);
      if (next == channel->second.begin() || std::prev(next)->second < end) return false;
    }
  }
  return true;
}

}  // namespace kinalign
