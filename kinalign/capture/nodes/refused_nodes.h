// SPDX-License-Identifier: Apache-2.0
// Which nodes are refused for their keys, as far as anybody can say: without a right MAC an id is a
// stranger's claim. So the table is fixed, the first ids stay in it, and what is told is limited.
#pragma once

#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

class RefusedNodes {
 public:
  static constexpr std::size_t most = 64;
  struct Claim {
    std::uint32_t node_id = 0;
    NodeRefusal refusal = NodeRefusal::none;  // no_key, no_mac or wrong_mac
    std::optional<HostTime> told;
  };

  /// Whether this one is to be told now: of all at most one a second, of each once in ten minutes.
  bool take(NodeRefusal refusal, std::uint32_t node_id, HostTime now);

  /// In the order in which they came.
  std::span<const Claim> claims() const { return std::span(claims_).first(used_); }
  /// Whether there were others, for which was no room.
  bool others(NodeRefusal refusal) const { return others_[static_cast<std::size_t>(refusal)]; }

 private:
  Claim& claim_of(NodeRefusal refusal, std::uint32_t node_id);

  std::array<Claim, most> claims_{};
  std::size_t used_ = 0;
  Claim rest_;  // all that had no room
  std::array<bool, node_refusals> others_{};
  std::optional<HostTime> told_;  // last
};

}  // namespace kinalign
