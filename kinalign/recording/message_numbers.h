// SPDX-License-Identifier: Apache-2.0
// Which messages of a recording are there: each channel numbers its own.
#pragma once

#include "kinalign/mcap/records.h"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace kinalign {

/// The numbers of the messages in a file, by channel.
class MessageNumbers {
 public:
  void add(const McapMessage& message);
  bool has(const McapMessage& message) const;
  bool has_all(const MessageNumbers& others) const;
  bool empty() const { return channels_.empty(); }
  std::vector<std::uint16_t> channels() const;
  /// Of a channel: that it has all of theirs from its own first one on, and some.
  bool goes_on_with(const MessageNumbers& others, std::uint16_t channel) const;
  /// Of a channel: that it has one of theirs.
  bool shares_with(const MessageNumbers& others, std::uint16_t channel) const;
  void add_all(const MessageNumbers& others);
  void add_all(const MessageNumbers& others, std::uint16_t channel);
  /// Of a channel the lowest one that is not below.
  std::optional<std::uint32_t> next(std::uint16_t channel, std::uint64_t from) const;
  /// Of a channel, each once.
  std::uint64_t present(std::uint16_t channel) const;
  /// Left out between the first and the last of a channel.
  std::uint64_t missing(std::uint16_t channel) const;

 private:
  using Stretches = std::map<std::uint32_t, std::uint64_t>;  // first number: behind the last one
  static void add(Stretches& stretches, std::uint32_t begin, std::uint64_t end);
  static bool has(const Stretches& stretches, std::uint32_t begin, std::uint64_t end);
  const Stretches& of(std::uint16_t channel) const;
  std::map<std::uint16_t, Stretches> channels_;
};

/// Of one file of a recording: whether what no checksum covers can be a message of it. It can where
/// its number fills a hole between those of its channel that one covers, or is above them by no
/// more than any sender could have brought in the time between.
class NumberGuard {
 public:
  /// Of what stands in front of all that one covers nothing is known: it is.
  bool believes(const McapMessage& message, bool unchecked);
  /// Those that were not believed.
  std::uint64_t strays() const { return strays_; }

 private:
  MessageNumbers proved_;  // that a checksum covers
  struct Last {
    std::uint32_t number = 0;
    std::uint64_t at = 0;  // its log time
  };
  std::map<std::uint16_t, Last> last_;  // by channel: the highest of these
  std::uint64_t strays_ = 0;
};

}  // namespace kinalign
