// SPDX-License-Identifier: Apache-2.0
// One exchange of packets between a node and the host, in the terms of RFC 5905 (T1 to T4).
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>

namespace kinalign {

/// Which life of a node a counter belongs to: its boot id, or a number of the caller's where a node
/// restarted without drawing a new one.
using BootKey = std::uint64_t;

/// A frame that arrived, and the echo that it carried.
struct Exchange {
  struct Echo {
    NodeTime n_rx{};  // T4 of RFC 5905: when the reply reached the node
    HostTime h_tx{};  // T3: when it was sent
  };
  BootKey boot = 0;
  NodeTime n_tx{};  // T1
  HostTime h_rx{};  // T2
  std::optional<Echo> echo;
};

}  // namespace kinalign
