// SPDX-License-Identifier: Apache-2.0
// The host's axis begins anew where it slept: another life for the clock of a device, which did not
// sleep. Exchanges say which epoch they are of; what a device says beside them does not.
#pragma once

#include "kinalign/recording/format.h"

#include <cstdint>
#include <map>
#include <vector>

namespace kinalign {

class HostEpochs {
 public:
  /// In the order of arrival.
  void add(const RecordedExchange& exchange);
  /// The life of what a device sent at `sent` of its clock. Between the last exchange of an epoch
  /// and the first of the next that one which is nearer to it by what the clocks differ.
  BootKey life_at(BootKey boot, NodeTime sent, HostTime arrival) const;

 private:
  struct Epoch {
    std::uint32_t number = 0;
    Exchange first, last;
  };
  std::map<BootKey, std::vector<Epoch>> boots_;
};

}  // namespace kinalign
