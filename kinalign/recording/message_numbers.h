// SPDX-License-Identifier: Apache-2.0
// The numbers of the messages in a recording. Each channel numbers its own messages.
#pragma once

#include "kinalign/mcap/records.h"

#include <cstdint>
#include <map>
#include <optional>

namespace kinalign {

/// A set of numbers for each channel, stored as ranges. The ranges of a channel have gaps between
/// them, so a complete recording needs one range per channel. The end of a range has 64 bits,
/// because one more than the last number may not fit into 32 bits.
class MessageNumbers {
 public:
  void add(const McapMessage& message);
  bool has(const McapMessage& message) const;
  /// The lowest number of a channel that is at least `from`.
  std::optional<std::uint32_t> next(std::uint16_t channel, std::uint64_t from) const;
  std::optional<std::uint32_t> last(std::uint16_t channel) const;
  /// The count of numbers missing between the first and the last, for one channel and for all
  /// channels.
  std::uint64_t missing(std::uint16_t channel) const;
  std::uint64_t missing() const;

 private:
  using Ranges = std::map<std::uint32_t, std::uint64_t>;  // first number: one more than the last
  const Ranges& ranges_of(std::uint16_t channel) const;
  std::map<std::uint16_t, Ranges> channels_;
};

}  // namespace kinalign
