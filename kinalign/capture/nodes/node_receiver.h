// SPDX-License-Identifier: Apache-2.0
// The nodes' port: sockets around a NodeDesk, and a clock for each node. Waits for nothing: who
// serves several ports (time_server.h) drains this one first.
#pragma once

#include "kinalign/capture/net/datagram_batch.h"
#include "kinalign/capture/net/host_clock.h"
#include "kinalign/capture/net/udp_socket.h"
#include "kinalign/capture/nodes/node_desk.h"
#include "kinalign/capture/nodes/node_lines.h"
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
  std::vector<std::string> addresses;  // empty: all, of IPv4 and IPv6
  std::uint16_t port = 0;              // 0: any free one, the same for all addresses
  NodeDeskOptions desk;
};

class NodeReceiver {
 public:
  NodeReceiver(NodeReceiver&&) noexcept;
  NodeReceiver& operator=(NodeReceiver&&) = delete;
  NodeReceiver(const NodeReceiver&) = delete;
  NodeReceiver& operator=(const NodeReceiver&) = delete;
  ~NodeReceiver();

  /// `clocks` has to stay.
  static Result<NodeReceiver> open(const NodeReceiverOptions& options, ClockReader& clocks);

  /// Takes and answers what has come, at most some hundred datagrams of each socket.
  void drain();
  /// Datagrams since it was opened, of whatever kind.
  std::uint64_t heard() const { return datagrams_; }
  /// Four times a second or so: who left, how the host's clocks run.
  void tick();

  /// Is told each datagram that got past port and key, in the order of arrival; of one that is
  /// accepted with its node's clock, which has heard of it, else with nullptr.
  using Watcher =
      std::function<void(const NodeArrival& arrival, const NodeNews& news, LiveClock* clock)>;
  void watch(Watcher watcher) { watcher_ = std::move(watcher); }

  const std::vector<UdpSocket>& sockets() const { return *sockets_; }
  /// Can be read where something has come.
  int fd() const { return lines_.fd(); }
  const NodeCounts& counts() const { return desk_->counts(); }
  const RefusedNodes& refused_nodes() const { return desk_->refused_nodes(); }
  std::uint64_t dropped() const { return lines_.dropped(); }  // by the kernel
  std::uint64_t unsent() const { return unsent_; }
  std::uint32_t epoch() const { return axis_.epoch(); }
  std::uint32_t node_id(std::size_t stream) const { return desk_->stream(stream).node_id; }
  /// Datagrams that were not looked into, for how they came.
  std::uint64_t not_unicast() const { return not_unicast_; }  // many would answer
  std::uint64_t from_port_0() const { return from_port_0_; }  // nobody would hear the answer
  /// By node id; of two nodes that have one, by stream.
  std::vector<NodeStatus> status() const;
  void replace_key(const LabKey& lab) { desk_->replace_key(lab, axis_.now()); }

  std::vector<NodeEvent> take_node_events() { return desk_->take_events(); }
  std::vector<HostClockEvent> take_host_events() { return axis_.take_events(); }
  struct StreamEvent {
    std::size_t stream = 0;
    std::uint32_t node_id = 0;
    ClockEvent event;
  };
  std::vector<StreamEvent> take_clock_events();
  /// Raw and wall clock, read once a second; since this was asked last.
  std::vector<ClockPair> take_pairs() { return pairs_.take(); }
  /// Events and pairs that were lost for want of room, since nobody took them. Of the events of a
  /// clock that was replaced (another node, another epoch) withdrawals may be among them.
  std::uint64_t missed_events() const;

 private:
  NodeReceiver(const NodeReceiverOptions& options, std::vector<UdpSocket> sockets,
               ClockReader& clocks);
  struct StreamClock;
  /// A datagram that waits until its batch is answered.
  struct Kept {
    NodeArrival arrival;
    NodeNews news;
    std::vector<NodeReading> readings;
  };
  bool may_answer(const Datagram& datagram);
  void take(const UdpSocket& socket, std::size_t datagrams);
  void keep(const NodeArrival& arrival, const NodeNews& news);
  LiveClock& hear(Kept& kept);
  void follow();
  StreamClock& clock_of(std::size_t stream);
  static void add_clock(NodeStatus& status, const StreamClock& clock);
  bool is_current(const StreamClock& clock, std::size_t stream) const;
  std::vector<StreamEvent> take_events_of(std::size_t stream);

  std::unique_ptr<std::vector<UdpSocket>> sockets_;
  NodeLines lines_;
  HostAxis axis_;
  std::unique_ptr<NodeDesk> desk_;
  std::unique_ptr<DatagramBatch> batch_;
  std::vector<std::unique_ptr<StreamClock>> clocks_;
  EventQueue<StreamEvent> last_events_;  // of clocks that were replaced
  std::uint64_t missed_events_ = 0;      // of these
  std::vector<Kept> kept_;
  std::size_t kept_length_ = 0;
  Watcher watcher_;
  std::vector<std::optional<HostAddress>> heard_;  // by stream: where its frames came to, this time
  std::uint64_t datagrams_ = 0, unsent_ = 0, not_unicast_ = 0, from_port_0_ = 0;
  HostTime next_watch_ = HostTime::min();
  EventQueue<ClockPair> pairs_;
};

}  // namespace kinalign
