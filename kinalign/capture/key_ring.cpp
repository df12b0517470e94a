// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/key_ring.h"

#include <utility>

namespace kinalign {

const MacKey* KeyRing::Derived::key_of(std::uint32_t node_id) {
  if (!lab) return nullptr;
  Key& place = kept[node_id % most];
  if (place.node_id != node_id) place = {node_id, node_key(*lab, node_id)};
  return &place.key;
}

const MacKey* KeyRing::old_key_of(std::uint32_t node_id, HostTime now) {
  return now < before_ends_ ? before_.key_of(node_id) : nullptr;
}

void KeyRing::replace(const LabKey& lab, HostTime now) {
  before_ = std::exchange(now_, Derived(lab));
  before_ends_ = now + old_key_lasts;
}

}  // namespace kinalign
