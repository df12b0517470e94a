// SPDX-License-Identifier: Apache-2.0
// The numbers of the messages in a recording. Each channel numbers its own messages.
#pragma once

#include "kinalign/mcap/records.h"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace kinalign {

/// The numbers of the messages in a file, by channel, as ranges.
class MessageNumbers {
 public:
  void add(const McapMessage& message);
  bool has(const McapMessage& message) const;
  bool has_all(const MessageNumbers& others) const;
  bool empty() const { return channels_.empty(); }
  std::vector<std::uint16_t> channels() const;
  /// Returns whether a channel has messages here, and from its first number on all those of
  /// `others`.
  bool goes_on_with(const MessageNumbers& others, std::uint16_t channel) const;
  /// Returns whether a channel has a number in common with `others`.
  bool shares_with(const MessageNumbers& others, std::uint16_t channel) const;
  void add_all(const MessageNumbers& others);
  void add_all(const MessageNumbers& others, std::uint16_t channel);
  /// The lowest number of a channel that is at least `from`.
  std::optional<std::uint32_t> next(std::uint16_t channel, std::uint64_t from) const;
  /// The number of different messages of a channel.
  std::uint64_t present(std::uint16_t channel) const;
  /// Numbers that are missing between the first and the last of a channel.
  std::uint64_t missing(std::uint16_t channel) const;

 private:
  // first number: one more than the last number
  using Stretches = std::map<std::uint32_t, std::uint64_t>;
  static void add(Stretches& stretches, std::uint32_t begin, std::uint64_t end);
  static bool has(const Stretches& stretches, std::uint32_t begin, std::uint64_t end);
  const Stretches& of(std::uint16_t channel) const;
  std::map<std::uint16_t, Stretches> channels_;
};

/// Decides for one file whether a message without a checksum can be genuine. It can if its number
/// fills a gap between numbers of checked messages of its channel, or if its number is above them
/// by no more than a sender could have sent in the elapsed time.
class NumberGuard {
 public:
  /// Returns whether the message is believed. Call in the order of the file. A message is believed
  /// if no earlier message of its channel was checked.
  bool believes(const McapMessage& message, bool unchecked);
  /// Messages that were not believed.
  std::uint64_t strays() const { return strays_; }

 private:
  MessageNumbers proved_;  // messages covered by a checksum
  struct Last {
    std::uint32_t number = 0;
    std::uint64_t at = 0;  // log time
  };
  std::map<std::uint16_t, Last> last_;  // by channel: the checked message with the highest number
  std::uint64_t strays_ = 0;
};

}  // namespace kinalign
