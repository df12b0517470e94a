// SPDX-License-Identifier: Apache-2.0
// A suspension of the host starts a new epoch of its time axis. A device that did not sleep then
// needs a new clock model. Exchanges contain their epoch; other messages of a device do not.
#pragma once

#include "kinalign/recording/format.h"

#include <cstdint>
#include <map>
#include <vector>

namespace kinalign {

/// The epochs in which a device's exchanges were made, for each boot of the device. Epochs of a
/// boot are in the order of arrival; each one keeps its first and its last exchange only.
class HostEpochs {
 public:
  /// Call in the order of arrival.
  void add(const RecordedExchange& exchange);
  /// The key of the clock model for a message that a device sent at `sent` of its clock. Between
  /// the last exchange of an epoch and the first of the next one, the epoch with the nearer clock
  /// offset is chosen.
  BootKey boot_at(BootKey boot, NodeTime sent, HostTime arrival) const;

 private:
  struct Epoch {
    std::uint32_t number = 0;
    Exchange first, last;
  };
  std::map<BootKey, std::vector<Epoch>> boots_;
};

}  // namespace kinalign
