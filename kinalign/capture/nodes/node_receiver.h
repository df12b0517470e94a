// SPDX-License-Identifier: Apache-2.0
// The nodes' port: the sockets, a NodeResponder, and one clock per node. No call blocks. A program
// that serves several ports (time_server.h) reads this port first.
#pragma once

#include "kinalign/capture/net/datagram_batch.h"
#include "kinalign/capture/net/host_clock.h"
#include "kinalign/capture/net/udp_socket.h"
#include "kinalign/capture/nodes/node_lines.h"
#include "kinalign/capture/nodes/node_responder.h"
#include "kinalign/capture/nodes/node_status.h"
#include "kinalign/clock/clock_event.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

class LiveClock;

struct NodeReceiverOptions {
  std::vector<std::string> addresses;  // empty: all addresses of IPv4 and IPv6
  std::uint16_t port = 0;              // 0: any free port, the same for all addresses
  NodeResponderOptions responder;
};

class NodeReceiver {
 public:
  NodeReceiver(NodeReceiver&&) noexcept;
  NodeReceiver& operator=(NodeReceiver&&) = delete;
  NodeReceiver(const NodeReceiver&) = delete;
  NodeReceiver& operator=(const NodeReceiver&) = delete;
  ~NodeReceiver();

  /// `clocks` must outlive the receiver.
  static Result<NodeReceiver> open(const NodeReceiverOptions& options, ClockReader& clocks);

  /// Reads and answers the waiting datagrams, at most a few hundred per socket.
  void drain();
  /// Number of datagrams since the port was opened, valid or not.
  std::uint64_t received() const { return datagrams_; }
  /// Call about four times a second. Reports nodes that fell silent and reads the host's clocks.
  void tick();

  /// Called for each datagram that passed the checks of port and key, in the order of arrival. If
  /// the datagram is accepted, `clock` is the clock of its node, already updated; otherwise
  /// nullptr.
  using Watcher =
      std::function<void(const NodeArrival& arrival, const NodeMessage& message, LiveClock* clock)>;
  void watch(Watcher watcher) { watcher_ = std::move(watcher); }

  const std::vector<UdpSocket>& sockets() const { return *sockets_; }
  /// Descriptor that becomes readable when a datagram is waiting.
  int fd() const { return lines_.fd(); }
  const NodeCounts& counts() const { return responder_->counts(); }
  const RefusedNodes& refused_nodes() const { return responder_->refused_nodes(); }
  std::uint64_t dropped() const { return lines_.dropped(); }  // datagrams dropped by the kernel
  /// The number of answers that the system did not accept.
  std::uint64_t unsent() const { return unsent_; }
  std::uint32_t epoch() const { return axis_.epoch(); }
  /// Numbers of ignored datagrams. Many hosts would answer a datagram to a broadcast or multicast
  /// address. An answer to port 0 could not be received.
  std::uint64_t not_unicast() const { return not_unicast_; }
  std::uint64_t from_port_0() const { return from_port_0_; }
  /// Sorted by node id; nodes with the same id are sorted by stream.
  std::vector<NodeStatus> status() const;
  /// Changes the lab key. The previous keys stay valid for one more minute.
  void replace_key(const LabKey& lab) { responder_->replace_key(lab, axis_.now()); }

  std::vector<NodeEvent> take_node_events() { return responder_->take_events(); }
  std::vector<HostClockEvent> take_host_events() { return axis_.take_events(); }
  struct StreamEvent {
    std::size_t stream = 0;
    std::uint32_t node_id = 0;
    ClockEvent event;
  };
  std::vector<StreamEvent> take_clock_events();
  /// Pairs of host time and UTC since the previous call. One pair is read each second.
  std::vector<ClockPair> take_pairs() { return pairs_.take(); }
  /// Number of events and pairs that were lost because the caller did not take them in time. Lost
  /// events may include withdrawn bounds of a clock that was replaced (by another node or in
  /// another epoch).
  std::uint64_t missed_events() const;

 private:
  NodeReceiver(const NodeReceiverOptions& options, std::vector<UdpSocket> sockets,
               ClockReader& clocks);
  struct StreamClock;
  /// A datagram that waits until the answers of its batch are sent.
  struct Kept {
    NodeArrival arrival;
    NodeMessage message;
    std::vector<NodeReading> readings;
  };
  bool may_answer(const Datagram& datagram);
  void take(const UdpSocket& socket, std::size_t datagrams);
  void keep(const NodeArrival& arrival, const NodeMessage& message);
  LiveClock& follow_clock(Kept& kept);
  void follow();
  StreamClock& clock_of(std::size_t stream);
  static void add_clock(NodeStatus& status, const StreamClock& clock);
  bool is_current(const StreamClock& clock, std::size_t stream) const;
  std::vector<StreamEvent> take_events_of(std::size_t stream);

  /// The sockets stay at one place in memory, because `lines_` refers to them.
  std::unique_ptr<std::vector<UdpSocket>> sockets_;
  NodeLines lines_;
  HostAxis axis_;
  std::unique_ptr<NodeResponder> responder_;
  std::unique_ptr<DatagramBatch> batch_;
  std::vector<std::unique_ptr<StreamClock>> clocks_;
  EventQueue<StreamEvent> last_events_;  // events of clocks that were replaced
  std::uint64_t missed_events_ = 0;      // lost events of clocks that were replaced
  std::vector<Kept> kept_;
  std::size_t kept_length_ = 0;
  Watcher watcher_;
  // by stream: destination address of its newest frame since the last follow()
  std::vector<std::optional<HostAddress>> arrived_at_;
  std::uint64_t datagrams_ = 0, unsent_ = 0, not_unicast_ = 0, from_port_0_ = 0;
  HostTime next_watch_ = HostTime::min();
  EventQueue<ClockPair> pairs_;
};

}  // namespace kinalign
