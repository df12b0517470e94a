// SPDX-License-Identifier: Apache-2.0
// A live node: the firmware's own logic (firmware/node) with samples made beforehand, a counter
// made of the host's clock, and a radio in both directions. Each sample has exactly the time for
// which it was made, however late this program wakes up: on a board a timer of higher priority
// takes the samples.
#pragma once

#include "apps/kinalign/simulate/live_socket.h"
#include "firmware/node/clockless_node.h"
#include "firmware/node/node.h"

#include "kinalign/capture/net/host_clock.h"
#include "kinalign/simulate/nodes/inertial_nodes.h"
#include "kinalign/simulate/nodes/packet_fates.h"

#include <cstdint>
#include <optional>
#include <queue>
#include <span>
#include <variant>
#include <vector>

namespace kinalign {

/// One direction of the node's simulated link. A fate is drawn for each datagram when it is put:
/// lost, delayed, or duplicated. The queue sorts by arrival, so datagrams may overtake each other
/// as on a real radio. The limit of waiting datagrams bounds the memory.
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

struct LiveNodeOptions {
  std::uint32_t id = 1, boot_id = 1;
  Link link = Link::paper;
  bool clockless = false;  // no counter: a request for each sample (wire/clockless.h)
  HostTime start{};        // time 0 of the motion
  double length_s = 0.0;   // the motion's, s
};

/// The counts of either kind of node.
struct LiveNodeCounts {
  std::uint64_t sent = 0, samples = 0;  // frames or requests, and the samples in them
  std::uint64_t answered = 0;           // answers of the host that reached the node
};

/// The functions of Board are called by the node's logic, inside of work(). Invariant: next_sample_
/// counts the samples that were taken.
class LiveNode final : public Board {
 public:
  LiveNode(const SimulatedNode& node, const LiveNodeOptions& options, ClockReader& clock,
           LiveSocket socket);
  LiveNode(const LiveNode&) = delete;
  LiveNode& operator=(const LiveNode&) = delete;
  ~LiveNode() = default;

  /// Does everything that is due.
  void work();
  /// The time of the next work, if no datagram arrives before.
  HostTime next() const;
  int fd() const { return socket_.fd(); }
  LiveNodeCounts counts();
  LiveTraffic traffic() { return socket_.traffic(); }

  std::uint64_t counter_us() override;
  bool read_imu(NodeSample& sample) override;
  bool send(std::span<const std::uint8_t> datagram) override;
  bool receive(std::span<std::uint8_t> room, std::size_t& size) override;
  bool read_battery(std::uint16_t&) override { return false; }
  void show(const Lights&) override {}
  void lock() override {}  // one thread needs no lock
  void unlock() override {}

 private:
  bool sample_due(std::uint64_t now_us) const {
    return next_sample_ < samples_.samples.size() &&
           samples_.samples[next_sample_].counter_us <= now_us;
  }
  // Both directions of the counter's clock: from the host's time, and back.
  std::uint64_t counter_at(HostTime t) const;
  HostTime host_at(std::uint64_t counter_us) const;

  const SimulatedNode& samples_;
  ClockReader& clock_;
  HostTime start_;
  SimulatedClock counter_;
  LiveSocket socket_;
  // up_ leads to the host, down_ to the node.
  LiveLink up_, down_;
  // Empty only during construction; then one of both kinds.
  std::variant<std::monostate, Node, ClocklessNode> node_;
  /// The next sample to take.
  std::size_t next_sample_ = 0;
  /// True while a sample is taken; counter_us() then gives its time.
  bool sampling_ = false;
};

}  // namespace kinalign
