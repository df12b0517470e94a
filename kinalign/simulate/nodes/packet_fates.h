// SPDX-License-Identifier: Apache-2.0
// The effect of a simulated link on each packet of one direction. It is for real sockets, for which
// the times of sending are not known in advance.
#pragma once

#include "kinalign/simulate/nodes/link.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// The effects are drawn in advance for packets at a constant rate. The real rate is nearly
/// constant.
class PacketFates {
 public:
  using Delay = std::chrono::nanoseconds;
  struct Fate {
    std::optional<Delay> first, duplicate;  // absent: the packet is lost
  };

  PacketFates(const LinkOptions& options, std::uint64_t seed, Way way, double rate_hz) {
    constexpr std::size_t packets = 1 << 16;  // the effects repeat after this number
    std::vector<double> sent(packets);
    for (std::size_t k = 0; k < packets; ++k) sent[k] = static_cast<double>(k) / rate_hz;
    const auto arrivals = transmit(options, seed, way, sent);
    for (std::size_t k = 0; k < packets; ++k) {
      const auto after = [&](const std::optional<double>& at) {
        return at ? std::optional(Delay{static_cast<std::int64_t>((*at - sent[k]) * 1e9)})
                  : std::nullopt;
      };
      fates_.push_back({after(arrivals[k].first), after(arrivals[k].duplicate)});
    }
  }
  /// Returns the effect on the next packet. Call once for each packet that is sent.
  const Fate& next() { return fates_[next_++ % fates_.size()]; }

 private:
  std::vector<Fate> fates_;
  std::size_t next_ = 0;
};

}  // namespace kinalign
