// SPDX-License-Identifier: Apache-2.0
// Distinguishes nodes and their sessions. The table has a fixed size of 64 streams and 256
// sessions.
//
// A session lasts from one start of a node to the next. Node id and boot id identify it. If two
// nodes have the same id and the same boot id, counters and addresses distinguish them. A stream is
// the data of one node over all its sessions.
#pragma once

#include "kinalign/capture/net/event_queue.h"
#include "kinalign/capture/nodes/node_event.h"
#include "kinalign/capture/nodes/node_session.h"

#include <vector>

namespace kinalign {

struct NodeStream {
  bool used = false;
  std::uint32_t number = 0;  // unique among the streams of this run
  std::uint32_t node_id = 0;
  std::size_t session = 0;  // the present session
  // Sessions of this stream, including the present one.
  std::uint64_t sessions = 0;
  std::optional<std::uint16_t> battery_mv;  // newest value sent by the node
  bool locked = false;  // the flag sent in its replies, see NodeResponder::set_locked
  bool silent = false;  // the event `left` was reported
};

/// The facts about one datagram by which the table recognises its session.
struct NodeSign {
  std::uint32_t node_id = 0, boot_id = 0;
  NodeAddress from;
  HostTime at{};
  std::uint32_t sequence = 0;
  std::optional<std::uint64_t> counter_us;  // absent: the node has no counter
};

/// Sessions are kept after their node has started again, as long as there is room. A late datagram
/// of such a session must not begin a new session.
class NodeTable {
 public:
  static constexpr std::size_t most_streams = 64, most_sessions = 256;

  NodeTable() : sessions_(most_sessions), streams_(most_streams) {}

  /// Returns the session that this datagram continues, or nullptr.
  NodeSession* session_of(const NodeSign& sign);
  /// Returns whether a session with these ids is known. Counter and address may differ.
  bool knows_boot(std::uint32_t node_id, std::uint32_t boot_id) const;
  /// Returns whether an admitted node has sent from this address within the last minute.
  bool knows_address(const HostAddress& host, HostTime now) const;

  /// Makes a held session, which is not admitted yet. Returns nullptr if there is no room.
  NodeSession* hold(const NodeSign& sign);
  /// Admits a held session. It becomes the present session of its node's stream or of a new stream.
  /// Returns false if there is no room.
  bool admit(NodeSession& session, HostTime now);
  /// Gives an earlier session its own stream, since two nodes have one id. Returns false if there
  /// is no room.
  bool part(NodeSession& session, HostTime now);
  /// Reports nodes that have fallen silent.
  void tick(HostTime now);

  NodeSession& session(std::size_t i) { return sessions_[i]; }
  const NodeSession& session(std::size_t i) const { return sessions_[i]; }
  NodeStream& stream(std::size_t i) { return streams_[i]; }
  const NodeStream& stream(std::size_t i) const { return streams_[i]; }

  void report(NodeEvent::Kind kind, const NodeSession& session, HostTime at);
  void report(const NodeEvent& event) { events_.add(event); }
  /// Events since the previous call. Events beyond the limit are counted in missed_events.
  std::vector<NodeEvent> take_events() { return events_.take(); }
  std::uint64_t missed_events() const { return events_.missed(); }

 private:
  NodeStream* stream_for(const NodeSession& session);
  NodeStream* new_stream(const NodeSession& session, HostTime now);
  NodeSession* room_for_session(const NodeSign& sign);
  void enter(NodeSession& session, NodeStream& stream, HostTime now);
  void report_name(const NodeSession& session, HostTime now);
  std::size_t index(const NodeSession& session) const;

  std::vector<NodeSession> sessions_;
  std::vector<NodeStream> streams_;
  std::uint32_t streams_made_ = 0;
  std::uint64_t restarts_ = 0;
  HostTime report_too_many_ = HostTime::min();  // too_many is not reported before this time
  EventQueue<NodeEvent> events_;
};

}  // namespace kinalign
