// SPDX-License-Identifier: Apache-2.0
// The nodes that are refused because of their keys. Without a valid MAC, any sender can claim any
// id. The table therefore has a fixed size and keeps the first ids. Reports are limited.
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
    // Time of the last report.
    std::optional<HostTime> reported;
  };

  /// Returns whether to report this refusal now. At most one report per second is made, and one per
  /// ten minutes for each node and cause.
  bool take(NodeRefusal refusal, std::uint32_t node_id, HostTime now);

  /// Refused ids in the order of their first datagrams.
  std::span<const Claim> claims() const { return std::span(claims_).first(used_); }
  /// Returns whether more nodes were refused for this cause than the table can hold.
  bool others(NodeRefusal refusal) const { return others_[static_cast<std::size_t>(refusal)]; }

 private:
  Claim& claim_of(NodeRefusal refusal, std::uint32_t node_id);

  std::array<Claim, most> claims_{};
  std::size_t used_ = 0;
  Claim rest_;  // shared by all claims beyond `most`
  std::array<bool, node_refusals> others_{};
  std::optional<HostTime> reported_;  // time of the last report of any claim
};

}  // namespace kinalign
