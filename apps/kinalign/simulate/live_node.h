// SPDX-License-Identifier: Apache-2.0
// Simulates an inertial node live. It runs the firmware's own code (firmware/node) on samples that
// were simulated beforehand. Its counter is computed from the host's clock, and a simulated radio
// delays both directions. Each sample has exactly its planned time, even if this program wakes up
// late: on a real board a timer of high priority takes the samples.
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

/// One direction of the node's simulated radio. When a datagram is put in, its fate is drawn at
/// random: lost, delayed or duplicated. The queue is sorted by the time of arrival, so datagrams
/// may come out of order, as on a real radio. The number of waiting datagrams has a limit.
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
  /// The earliest datagram that has arrived by `now`. Empty if none has arrived.
  std::optional<std::vector<std::uint8_t>> take(HostTime now) {
    if (waiting_.empty() || waiting_.top().at > now) return std::nullopt;
    auto datagram = waiting_.top().datagram;
    waiting_.pop();
    return datagram;
  }
  /// The time at which the next datagram arrives.
  HostTime next() const { return waiting_.empty() ? HostTime::max() : waiting_.top().at; }

 private:
  static constexpr std::size_t most_waiting = 10'000;
  struct Packet {
    HostTime at;
    std::vector<std::uint8_t> datagram;

    bool operator<(const Packet& other) const { return at > other.at; }  // puts the earliest on top
  };

  PacketFates fates_;
  std::priority_queue<Packet> waiting_;
};

struct LiveNodeOptions {
  std::uint32_t id = 1, boot_id = 1;
  Link link = Link::paper;
  bool clockless = false;  // true: no counter, one request for each sample (wire/clockless.h)
  HostTime start{};        // the host's time at which the motion begins
  double length_s = 0.0;   // length of the motion, s
};

/// The counts of a node, with or without a counter.
struct LiveNodeCounts {
  std::uint64_t sent = 0, samples = 0;  // frames or requests, and their samples
  std::uint64_t answered = 0;           // replies of the host that reached the node
};

/// A live node. During work() the firmware's code calls the functions of Board. Invariant:
/// next_sample_ samples have been taken.
class LiveNode final : public Board {
 public:
  LiveNode(const SimulatedNode& node, const LiveNodeOptions& options, ClockReader& clock,
           LiveSocket socket);
  LiveNode(const LiveNode&) = delete;
  LiveNode& operator=(const LiveNode&) = delete;
  ~LiveNode() = default;

  /// Does all work that is due.
  void work();
  /// The time at which work() must be called next, if no datagram arrives before.
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
  // Convert between the host's time and the node's counter.
  std::uint64_t counter_at(HostTime t) const;
  HostTime host_at(std::uint64_t counter_us) const;

  const SimulatedNode& samples_;
  ClockReader& clock_;
  HostTime start_;
  SimulatedClock counter_;
  LiveSocket socket_;
  // up_ is the radio to the host, down_ the radio to the node.
  LiveLink up_, down_;
  // The firmware's code, with or without a counter. It is empty only during construction.
  std::variant<std::monostate, Node, ClocklessNode> node_;
  /// The index of the next sample to take.
  std::size_t next_sample_ = 0;
  /// True while a sample is taken; counter_us() then returns the sample's time.
  bool sampling_ = false;
};

}  // namespace kinalign
