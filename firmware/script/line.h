// SPDX-License-Identifier: Apache-2.0
// Messages over a line of bytes; each begins with its length.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// A serial port, or a pipe.
class Line {
 public:
  /// Waits until `bytes` is full. False at the line's end.
  virtual bool read(std::span<std::uint8_t> bytes) = 0;
  virtual void write(std::span<const std::uint8_t> bytes) = 0;

 protected:
  ~Line() = default;
};

inline constexpr std::size_t longest_message = 1500;

/// Reads a message: u16 length of the rest, big-endian; a letter for the kind; its fields. False at
/// the line's end, and if a message is empty or too long: after that the next message can't be
/// found.
bool read_message(Line& line, std::span<std::uint8_t, longest_message> room, std::size_t& size);
void write_message(Line& line, char kind, std::span<const std::uint8_t> fields);

}  // namespace kinalign
