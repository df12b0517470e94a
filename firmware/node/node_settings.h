// SPDX-License-Identifier: Apache-2.0
// What a node is told at its start.
#pragma once

#include "kinalign/wire/node_datagram.h"

#include <cstdint>

namespace kinalign {

struct NodeSettings {
  std::uint32_t node_id = 0;
  std::uint32_t boot_id = 0;  // new at every start
  bool has_key = false;
  MacKey key{};
  std::uint32_t frame_period_us = 66'667;  // 15 a second; 30 samples fit in each
  std::uint32_t dither_us = 1000;
  bool narrow_counter =
      false;  // stamps leave modulo 2^32, as of a node that does not widen its own
};

}  // namespace kinalign
