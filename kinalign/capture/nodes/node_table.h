// SPDX-License-Identifier: Apache-2.0
// Nodes and their lives, told apart: 64 streams, 256 lives, and not one more, whatever arrives.
//
// A life is (node id, boot id), unless two nodes were given one id and draw one boot id: then their
// counters and addresses tell. A stream is what one node sends, over all its lives.
#pragma once

#include "kinalign/capture/net/event_queue.h"
#include "kinalign/capture/nodes/node_event.h"
#include "kinalign/capture/nodes/node_life.h"

#include <vector>

namespace kinalign {

struct NodeStream {
  bool used = false;
  std::uint32_t number = 0;  // of this run: no two streams have the same
  std::uint32_t node_id = 0;
  std::size_t life = 0;  // the present one
  std::uint64_t lives = 0;
  std::optional<std::uint16_t> battery_mv;  // as the node said last
  bool locked = false;                      // as its replies say
  bool silent = false;                      // `left` was told
};

/// One datagram as far as the table is concerned.
struct NodeSign {
  std::uint32_t node_id = 0, boot_id = 0;
  NodeAddress from;
  HostTime at{};
  std::uint32_t sequence = 0;
  std::optional<std::uint64_t> counter_us;  // absent: the node has none
};

class NodeTable {
 public:
  static constexpr std::size_t most_streams = 64, most_lives = 256;

  NodeTable() : lives_(most_lives), streams_(most_streams) {}

  /// The life that this continues; nullptr: none.
  NodeLife* life_of(const NodeSign& sign);
  /// Whether a life with these ids is known, whatever its counter and address.
  bool knows_boot(std::uint32_t node_id, std::uint32_t boot_id) const;
  /// Somebody whose frames were taken within the last minute sends from there.
  bool knows_address(const HostAddress& host, HostTime now) const;

  /// A life that is held; nullptr: no room.
  NodeLife* hold(const NodeSign& sign);
  /// It is one of ours: the present life of its node's stream, or of a new one. False: no room.
  bool admit(NodeLife& life, HostTime now);
  /// Two nodes have one id: this earlier life goes on in a stream of its own. False: no room.
  bool part(NodeLife& life, HostTime now);
  /// Says who has left.
  void tick(HostTime now);

  NodeLife& life(std::size_t i) { return lives_[i]; }
  const NodeLife& life(std::size_t i) const { return lives_[i]; }
  NodeStream& stream(std::size_t i) { return streams_[i]; }
  const NodeStream& stream(std::size_t i) const { return streams_[i]; }

  void tell(NodeEvent::Kind kind, const NodeLife& life, HostTime at);
  void tell(const NodeEvent& event) { events_.add(event); }
  /// What was told since this was asked last, and how many more had no room.
  std::vector<NodeEvent> take_events() { return events_.take(); }
  std::uint64_t missed_events() const { return events_.missed(); }

 private:
  NodeStream* stream_for(const NodeLife& life);
  NodeStream* new_stream(const NodeLife& life, HostTime now);
  NodeLife* room_for_life(const NodeSign& sign);
  void enter(NodeLife& life, NodeStream& stream, HostTime now);
  void tell_name(const NodeLife& life, HostTime now);
  std::size_t index(const NodeLife& life) const;

  std::vector<NodeLife> lives_;
  std::vector<NodeStream> streams_;
  std::uint32_t streams_made_ = 0;
  std::uint64_t restarts_ = 0;
  HostTime tell_too_many_ = HostTime::min();  // not sooner
  EventQueue<NodeEvent> events_;
};

}  // namespace kinalign
