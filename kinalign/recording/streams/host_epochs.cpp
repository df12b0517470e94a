// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/host_epochs.h"

#include <algorithm>
#include <iterator>

namespace kinalign {

namespace {

/// Host time minus device time.
Duration offset_of(NodeTime sent, HostTime arrival) {
  return arrival.time_since_epoch() - sent.time_since_epoch();
}
Duration offset_of(const Exchange& e) { return offset_of(e.n_tx, e.h_rx); }

}  // namespace

void HostEpochs::add(const RecordedExchange& recorded) {
  std::vector<Epoch>& epochs = boots_[recorded.exchange.boot];
  if (epochs.empty() || epochs.back().number != recorded.epoch) {
    epochs.push_back({recorded.epoch, recorded.exchange, recorded.exchange});
  }
  epochs.back().last = recorded.exchange;
}

// The key of the clock model for a message. If the message arrived between two epochs, it could
// belong to either of them. The device's clock does not jump, so the epoch with the more similar
// clock offset is chosen.
BootKey HostEpochs::boot_at(BootKey boot, NodeTime sent, HostTime arrival) const {
  // A boot without exchanges has a single clock model.
  const auto found = boots_.find(boot);
  if (found == boots_.end()) return boot;
  const std::vector<Epoch>& epochs = found->second;
  const auto next = std::find_if(epochs.begin(), epochs.end(), [arrival](const Epoch& epoch) {
    return arrival <= epoch.last.h_rx;
  });
  // The newest epoch continues after its last exchange.
  if (next == epochs.end()) return boot_in_epoch(boot, epochs.back().number);
  if (next == epochs.begin() || arrival >= next->first.h_rx) {
    return boot_in_epoch(boot, next->number);
  }
  const Epoch& before = *std::prev(next);
  const auto from = [at = offset_of(sent, arrival)](const Exchange& e) {
    return std::chrono::abs(at - offset_of(e));
  };
  const bool is_before = from(before.last) < from(next->first);
  return boot_in_epoch(boot, is_before ? before.number : next->number);
}

}  // namespace kinalign
