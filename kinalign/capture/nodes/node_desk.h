// SPDX-License-Identifier: Apache-2.0
// The nodes' protocol on the host's side (docs/formats/imu_node.md): what becomes of each datagram,
// what is answered, and what it says of its node's clock. No socket, no clock and no growth: time
// is an argument, and every fault is tested without either.
#pragma once

#include "kinalign/capture/net/rate_limit.h"
#include "kinalign/capture/nodes/node_keys.h"
#include "kinalign/capture/nodes/node_table.h"
#include "kinalign/capture/nodes/node_verdict.h"
#include "kinalign/capture/nodes/refused_nodes.h"
#include "kinalign/clock/offline/clockless.h"
#include "kinalign/wire/clockless.h"
#include "kinalign/wire/node_frame.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

struct NodeArrival {
  std::span<const std::uint8_t> bytes;
  NodeAddress from;
  HostTime h_rx{};              // T2 of RFC 5905; of a confirm T6
  std::optional<Time> stamp{};  // the kernel's
};

/// A sample, and the counter when it was taken; of a node without one the zero of NodeTime.
struct NodeReading {
  NodeTime n{};
  NodeSample sample;
  SampleFaults faults;
};

/// What an accepted datagram brought. A frame has an exchange, a confirm a clockless one.
struct NodeNews {
  NodeVerdict verdict = NodeVerdict::refused;
  std::uint32_t node_id = 0;  // as it says: of what is not refused its key vouches for it, if any
  std::size_t stream = 0;     // if accepted
  std::uint64_t frame = 0;    // its number, widened; lost ones count
  std::optional<Exchange> exchange;
  std::optional<ClocklessExchange> clockless;
  std::span<const NodeReading> readings;  // oldest first; good until the next datagram
};

struct NodeDeskOptions {
  std::optional<LabKey> lab_key;
  SipHashKey secret{};  // random in each run: nonces and the strangers' table come from it
};

class NodeDesk {
 public:
  explicit NodeDesk(const NodeDeskOptions& options);

  /// In the order of arrival.
  NodeNews receive(const NodeArrival& arrival);
  /// The answer to the datagram before, at the front of `out`; empty: none is due. It is never the
  /// longer of the two, as their layouts are. `h_tx` was read before this call, and what is
  /// returned is to be sent at once.
  std::span<const std::uint8_t> answer(HostTime h_tx, std::span<std::uint8_t> out);

  /// Says what replies tell the node: the host has an interval for its clock.
  void set_locked(std::size_t stream, bool locked) { table_.stream(stream).locked = locked; }
  /// The present keys are good for a minute more.
  void replace_key(const LabKey& lab, HostTime now) { keys_.replace(lab, now); }
  /// Now and then.
  void tick(HostTime now) { table_.tick(now); }

  const NodeStream& stream(std::size_t i) const { return table_.stream(i); }
  const NodeLife& life_of(const NodeStream& stream) const { return table_.life(stream.life); }
  const NodeCounts& counts() const { return counts_; }
  const RefusedNodes& refused_nodes() const { return refused_nodes_; }
  std::vector<NodeEvent> take_events() { return table_.take_events(); }
  std::uint64_t missed_events() const { return table_.missed_events(); }

 private:
  NodeVerdict judge(const NodeArrival& arrival, NodeNews& news);
  NodeVerdict judge_frame(const NodeArrival& arrival, const Envelope& envelope, NodeNews& news);
  NodeVerdict judge_request(const NodeArrival& arrival, const Envelope& envelope, NodeNews& news);
  NodeVerdict judge_confirm(const NodeArrival& arrival, const Envelope& envelope, NodeNews& news);
  template <class Datagram>
  bool unlock(const Envelope& envelope, const NodeArrival& arrival, Datagram& datagram);
  NodeVerdict find_life(const NodeSign& sign, NodeLife*& life);
  NodeVerdict find_place(const NodeSign& sign, std::uint32_t sequence, NodeLife*& life,
                         NodeNews& news);
  NodeVerdict take_life(NodeLife& life, const NodeSign& sign, std::optional<HostTime> echoed);
  std::optional<Exchange::Echo> take_echo(NodeLife& life, std::int64_t n_tx_us);
  void keep(std::span<const NodeSample> samples, std::optional<std::int64_t> n_tx_us,
            NodeNews& news);
  void accept(NodeLife& life, const NodeSign& sign, bool newest, NodeNews& news);
  void refuse(NodeRefusal refusal, std::uint8_t version, HostTime now);
  void tell_wrong_key(NodeRefusal refusal, const DatagramOrigin& origin,
                      const NodeArrival& arrival);

  SipHashKey secret_;
  KeyRing keys_;
  NodeTable table_;
  RateLimit strangers_;
  NodeCounts counts_;
  std::uint64_t nonces_ = 0;
  RefusedNodes refused_nodes_;

  // of the datagram before
  NodeFrame frame_;
  std::array<NodeReading, max_node_samples> readings_{};
  /// What `answer` has to know of it.
  struct Asked {
    NodeLife* by = nullptr;  // nullptr: it is not answered
    DatagramOrigin origin;
    DatagramType type{};
    HostTime h_rx{};
    std::uint64_t frame = 0;
    std::optional<MacKey> key;  // that it came with; none: it has no MAC
    bool old_key = false;
  } asked_;
};

}  // namespace kinalign
