// SPDX-License-Identifier: Apache-2.0
// The host's side of the nodes' protocol (docs/formats/imu_node.md). It judges each datagram, makes
// the answer, and extracts the clock readings and samples. It uses no socket and no clock, and its
// memory is fixed. The caller passes the time, so tests can produce every fault.
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
  HostTime h_rx{};  // arrival: T2 of RFC 5905; for a confirm T6
};

/// A sample and the node's counter when it was taken. If the node has no counter, n is zero.
struct NodeReading {
  NodeTime n{};
  NodeSample sample;
  SampleFaults faults;
};

/// The content of a datagram. An accepted frame has `exchange`; an accepted confirm has
/// `clockless`.
struct NodeMessage {
  NodeVerdict verdict = NodeVerdict::refused;
  // claimed id; proved by the MAC if a key is used and the datagram is not refused
  std::uint32_t node_id = 0;
  std::size_t stream = 0;   // set only if the datagram is accepted
  std::uint64_t frame = 0;  // unwrapped number of the datagram; gaps show lost datagrams
  bool late = false;        // a frame or request with a higher number arrived earlier
  std::optional<Exchange> exchange;
  std::optional<ClocklessExchange> clockless;
  std::span<const NodeReading> readings;  // oldest first; valid until the next datagram
};

struct NodeResponderOptions {
  std::optional<LabKey> lab_key;
  // random in each run; used for nonces and for hashes of unknown senders
  SipHashKey secret{};
};

/// For each datagram call receive(), then answer(), before the next datagram.
class NodeResponder {
 public:
  explicit NodeResponder(const NodeResponderOptions& options);

  /// Judges one datagram. Call in the order of arrival.
  NodeMessage receive(const NodeArrival& arrival);
  /// Writes the answer to the previous datagram to the front of `out`. Empty: there is no answer.
  /// An answer is never longer than its request, because of the message layouts. `h_tx` must be
  /// read just before this call, and the answer must be sent at once.
  std::span<const std::uint8_t> answer(HostTime h_tx, std::span<std::uint8_t> out);

  /// Sets the flag in replies which tells a node that the host has a certified interval for the
  /// node's clock.
  void set_locked(std::size_t stream, bool locked) { table_.stream(stream).locked = locked; }
  /// Changes the lab key. The previous keys stay valid for one more minute.
  void replace_key(const LabKey& lab, HostTime now) { keys_.replace(lab, now); }
  /// Call from time to time. Reports nodes that fell silent.
  void tick(HostTime now) { table_.tick(now); }

  const NodeStream& stream(std::size_t i) const { return table_.stream(i); }
  const NodeSession& session_of(const NodeStream& stream) const {
    return table_.session(stream.session);
  }
  const NodeCounts& counts() const { return counts_; }
  const RefusedNodes& refused_nodes() const { return refused_nodes_; }
  std::vector<NodeEvent> take_events() { return table_.take_events(); }
  std::uint64_t missed_events() const { return table_.missed_events(); }

 private:
  /// `judge` passes a datagram to the function for its type. That function finds or admits the
  /// session and fills `message`.
  NodeVerdict judge(const NodeArrival& arrival, NodeMessage& message);
  NodeVerdict judge_frame(const NodeArrival& arrival, const Envelope& envelope,
                          NodeMessage& message);
  NodeVerdict judge_request(const NodeArrival& arrival, const Envelope& envelope,
                            NodeMessage& message);
  NodeVerdict judge_confirm(const NodeArrival& arrival, const Envelope& envelope,
                            NodeMessage& message);
  template <class Datagram>
  bool unlock(const Envelope& envelope, const NodeArrival& arrival, Datagram& datagram);
  NodeVerdict find_session(const NodeSign& sign, NodeSession*& session);
  NodeVerdict find_place(const NodeSign& sign, NodeSession*& session, NodeMessage& message);
  NodeVerdict take_session(NodeSession& session, const NodeSign& sign,
                           std::optional<HostTime> echoed);
  std::optional<Exchange::Echo> take_echo(NodeSession& session, std::int64_t n_tx_us);
  void keep(std::span<const NodeSample> samples, std::optional<std::int64_t> n_tx_us,
            NodeMessage& message);
  void accept(NodeSession& session, const NodeSign& sign, NodeMessage& message);
  void refuse(NodeRefusal refusal, std::uint8_t version, HostTime now);
  void report_wrong_key(NodeRefusal refusal, const DatagramOrigin& origin,
                        const NodeArrival& arrival);

  SipHashKey secret_;
  KeyRing keys_;
  NodeTable table_;
  RateLimit unknown_senders_;
  NodeCounts counts_;
  std::uint64_t nonces_ = 0;
  RefusedNodes refused_nodes_;

  // State of the previous datagram.
  NodeFrame frame_;
  std::array<NodeReading, max_node_samples> readings_{};
  /// The data that `answer` needs.
  struct Asked {
    NodeSession* by = nullptr;  // nullptr: the datagram is not answered
    DatagramOrigin origin;
    DatagramType type{};
    HostTime h_rx{};
    std::uint64_t frame = 0;
    std::optional<MacKey> key;  // the key of the datagram's MAC; absent: the datagram has no MAC
    bool old_key = false;
  } asked_;
};

}  // namespace kinalign
