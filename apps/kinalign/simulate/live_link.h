// SPDX-License-Identifier: Apache-2.0
// One direction of a simulated link: datagrams wait in it until they arrive, or are lost.
#pragma once

#include "kinalign/simulate/nodes/packet_fates.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>
#include <queue>
#include <span>
#include <vector>

namespace kinalign {

/// A fate is drawn for each datagram when it is put: lost, delayed, or duplicated. The queue sorts
/// by arrival, so datagrams may overtake each other as on a real radio. The limit of waiting
/// datagrams bounds the memory.
class LiveLink {
 public:
  LiveLink(const LinkOptions& options, std::uint64_t seed, Way way, double rate_hz)
      : fates_(options, seed, way, rate_hz) {}

  void put(HostTime now, std::span<const std::uint8_t> datagram) {
    const PacketFates::Fate& fate = fates_.next();
    for (const auto& delay : {fate.first, fate.duplicate}) {
      if (delay && waiting_.size() < most_waiting) {
        waiting_.push({now + *delay, {datagram.begin(), datagram.end()}});
      }
    }
  }
  /// The earliest datagram that has arrived by `now`; absent if there is none.
  std::optional<std::vector<std::uint8_t>> take(HostTime now) {
    if (waiting_.empty() || waiting_.top().at > now) return std::nullopt;
    auto datagram = waiting_.top().datagram;
    waiting_.pop();
    return datagram;
  }
  /// The arrival of the next datagram.
  HostTime next() const { return waiting_.empty() ? HostTime::max() : waiting_.top().at; }

 private:
  static constexpr std::size_t most_waiting = 10'000;
  struct Packet {
    HostTime at;
    std::vector<std::uint8_t> datagram;

    bool operator<(const Packet& other) const { return at > other.at; }  // the earliest on top
  };

  PacketFates fates_;
  std::priority_queue<Packet> waiting_;
};

}  // namespace kinalign
