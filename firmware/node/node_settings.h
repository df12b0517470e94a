// SPDX-License-Identifier: Apache-2.0
// The settings of a node.
#pragma once

#include "kinalign/wire/node_datagram.h"

#include <cstdint>

namespace kinalign {

struct NodeSettings {
  std::uint32_t node_id = 0;
  std::uint32_t boot_id = 0;  // different at every start
  bool has_key = false;
  MacKey key{};
  std::uint32_t frame_period_us = 66'667;  // 15 frames a second; 30 samples fit in each
  std::uint32_t dither_us = 1000;
  bool narrow_counter =
      false;  // stamps are sent modulo 2^32, like those of a node with a 32-bit counter
};

}  // namespace kinalign
