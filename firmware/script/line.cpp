// SPDX-License-Identifier: Apache-2.0
#include "firmware/script/line.h"

#include <array>

namespace kinalign {

bool read_message(Line& line, std::span<std::uint8_t, longest_message> room, std::size_t& size) {
  std::array<std::uint8_t, 2> length{};
  if (!line.read(length)) return false;
  size = static_cast<std::size_t>(length[0] << 8 | length[1]);
  return size > 0 && size <= room.size() && line.read(room.first(size));
}

void write_message(Line& line, char kind, std::span<const std::uint8_t> fields) {
  const std::size_t size = fields.size() + 1;
  const std::array<std::uint8_t, 3> head{static_cast<std::uint8_t>(size >> 8),
                                         static_cast<std::uint8_t>(size),
                                         static_cast<std::uint8_t>(kind)};
  line.write(head);
  if (!fields.empty()) line.write(fields);
}

}  // namespace kinalign
