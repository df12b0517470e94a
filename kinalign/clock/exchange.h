// SPDX-License-Identifier: Apache-2.0
// One exchange of packets between a node and the host, with the times T1 to T4 of RFC 5905.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>

namespace kinalign {

/// Identifies one boot of a node, within which its counter is continuous. It is the boot id. If a
/// node restarts without a new id, the caller chooses another number.
using BootKey = std::uint64_t;

/// A frame that has arrived, with the echo that it contains.
struct Exchange {
  struct Echo {
    NodeTime n_rx{};  // T4 of RFC 5905: the reply arrived at the node
    HostTime h_tx{};  // T3: the host sent the reply
  };
  BootKey boot = 0;
  NodeTime n_tx{};  // T1: the node sent the frame
  HostTime h_rx{};  // T2: the frame arrived at the host
  std::optional<Echo> echo;
};

}  // namespace kinalign
