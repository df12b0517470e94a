// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/refused_nodes.h"

#include <algorithm>

namespace kinalign {

namespace {

// At most one report per `any_every` is made, and one per `each_every` for each claim.
constexpr Duration any_every = std::chrono::seconds(1);
constexpr Duration each_every = std::chrono::minutes(10);

}  // namespace

// Claims beyond the limit share one entry.
RefusedNodes::Claim& RefusedNodes::claim_of(NodeRefusal refusal, std::uint32_t node_id) {
  const auto end = claims_.begin() + static_cast<std::ptrdiff_t>(used_);
  const auto found = std::find_if(claims_.begin(), end, [&](const Claim& claim) {
    return claim.node_id == node_id && claim.refusal == refusal;
  });
  if (found != end) return *found;
  if (used_ < most) {
    claims_[used_] = {node_id, refusal, std::nullopt};
    return claims_[used_++];
  }
  others_[static_cast<std::size_t>(refusal)] = true;
  return rest_;
}

// A report that the limit suppresses is made later, with another datagram of the same node.
bool RefusedNodes::take(NodeRefusal refusal, std::uint32_t node_id, HostTime now) {
  Claim& claim = claim_of(refusal, node_id);
  if (claim.reported && now - *claim.reported < each_every) return false;
  if (reported_ && now - *reported_ < any_every) return false;
  claim.reported = reported_ = now;
  return true;
}

}  // namespace kinalign
