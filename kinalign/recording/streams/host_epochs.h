// SPDX-License-Identifier: Apache-2.0
// If the host is suspended, its clock jumps and a new epoch begins. A device that was not suspended
// then needs a new clock model. Exchanges contain the number of their epoch, but other messages do
// not.
#pragma once

#include "kinalign/recording/format.h"

#include <cstdint>
#include <map>
#include <vector>

namespace kinalign {

/// The epochs of a device's exchanges, for each boot of the device. The epochs of a boot are in the
/// order of arrival. Only the first and the last exchange of an epoch are kept.
class HostEpochs {
 public:
  /// Call this in the order of arrival.
  void add(const RecordedExchange& exchange);
  /// The key of the clock model for a message that arrived at `arrival`. `sent`: the device's clock
  /// at sending. Between the last exchange of an epoch and the first exchange of the next one, the
  /// epoch with the more similar clock offset is chosen.
  BootKey boot_at(BootKey boot, NodeTime sent, HostTime arrival) const;

 private:
  struct Epoch {
    std::uint32_t number = 0;
    Exchange first, last;
  };
  std::map<BootKey, std::vector<Epoch>> boots_;
};

}  // namespace kinalign
