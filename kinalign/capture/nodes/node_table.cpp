// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_table.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace kinalign {

namespace {

using State = NodeSession::State;
using Kind = NodeEvent::Kind;

// a late frame may be this much older than a frame that arrived before
constexpr std::int64_t most_back_us = 1'000'000;
// greatest jump of the counter that is accepted together with a new address
constexpr std::int64_t most_ahead_us = 2'000'000;
// Time for which an address stays known and a silent node's stream is not reused.
constexpr Duration known_for = std::chrono::seconds(60);
constexpr Duration left_after = std::chrono::seconds(10);
constexpr Duration held_for = std::chrono::seconds(1);  // a held session is kept at least this long
constexpr std::size_t most_held = 4;                    // held sessions of one node id

// Returns whether the session is in use and has both ids.
bool has_ids(const NodeSession& session, std::uint32_t node_id, std::uint32_t boot_id) {
  return session.state != State::free && session.node_id == node_id && session.boot_id == boot_id;
}

/// Returns whether a datagram with the same ids may continue this session, judged by its counter,
/// sequence number and address.
bool continues(const NodeSession& session, const NodeSign& sign) {
  if (!sign.counter_us) return true;
  const std::int64_t n = session.counter.unwrap(*sign.counter_us, sign.at);
  const std::int64_t behind = session.counter.behind_us(n);
  if (behind > most_back_us) return false;
  // If the counter has a later value, but the sequence number is earlier or far behind, then the
  // node has started again. The counter only seems to continue: a 32-bit counter was unwrapped by
  // mistake, or the node has run nearly as long as before.
  const auto place = session.sequences.place_of(session.sequences.unwrap(sign.sequence));
  if (behind < 0 && place != Counter::Place::ahead) return false;
  if (place == Counter::Place::behind) return false;
  // If the address is unchanged, a jump ahead is a step of the node's counter. The clock model will
  // detect that step.
  return session.address == sign.from || session.counter.ahead_us(n, sign.at) <= most_ahead_us;
}

/// Orders the sessions that a datagram may continue; a greater value is more likely. After a
/// restart, the new counter at some time passes the value at which the earlier session ended. The
/// datagram then belongs to the present session of the same address, or else to the session that
/// predicted the counter.
auto likelihood(const NodeSession& session, const NodeSign& sign) {
  const bool live = session.state == State::live, here = session.address == sign.from;
  bool predicted = true;
  if (sign.counter_us) {
    const std::int64_t n = session.counter.unwrap(*sign.counter_us, sign.at);
    predicted = std::abs(session.counter.ahead_us(n, sign.at)) <= most_ahead_us;
  }
  return std::tuple(predicted || (live && here), here, live);
}

}  // namespace

std::size_t NodeTable::index(const NodeSession& session) const {
  return static_cast<std::size_t>(&session - sessions_.data());
}

NodeSession* NodeTable::session_of(const NodeSign& sign) {
  NodeSession* best = nullptr;
  for (NodeSession& session : sessions_) {
    if (!has_ids(session, sign.node_id, sign.boot_id) || !continues(session, sign)) continue;
    if (best == nullptr || likelihood(session, sign) > likelihood(*best, sign)) best = &session;
  }
  return best;
}

bool NodeTable::knows_boot(std::uint32_t node_id, std::uint32_t boot_id) const {
  return std::any_of(sessions_.begin(), sessions_.end(), [&](const NodeSession& session) {
    return has_ids(session, node_id, boot_id) && session.state != State::held;
  });
}

bool NodeTable::knows_address(const HostAddress& host, HostTime now) const {
  return std::any_of(sessions_.begin(), sessions_.end(), [&](const NodeSession& session) {
    return session.state == State::live && session.address.host == host &&
           now - session.last_arrival <= known_for;
  });
}

/// Returns a free place. If none is free, the place of the session silent longest is reused, but
/// not that of a stream's present session. If a node already has most_held held sessions, its
/// oldest held session is replaced.
NodeSession* NodeTable::room_for_session(const NodeSign& sign) {
  NodeSession* oldest = nullptr;
  NodeSession* oldest_held = nullptr;
  std::size_t held = 0;
  for (NodeSession& session : sessions_) {
    const bool own = session.state == State::held && session.node_id == sign.node_id;
    if (own) ++held;
    if (own && (oldest_held == nullptr || session.begun < oldest_held->begun))
      oldest_held = &session;
    if (session.state == State::live) continue;
    const auto age = [](const NodeSession& l) {
      return std::pair(l.state != State::free, l.last_arrival);
    };
    if (oldest == nullptr || age(session) < age(*oldest)) oldest = &session;
  }
  NodeSession* room = held >= most_held ? oldest_held : oldest;
  const bool young =
      room != nullptr && room->state == State::held && sign.at - room->begun < held_for;
  return young ? nullptr : room;
}

NodeSession* NodeTable::hold(const NodeSign& sign) {
  const auto same =
      std::find_if(sessions_.begin(), sessions_.end(), [&](const NodeSession& session) {
        return has_ids(session, sign.node_id, sign.boot_id) && session.state == State::held &&
               session.address == sign.from;
      });
  NodeSession* session = same != sessions_.end() ? &*same : room_for_session(sign);
  if (session == nullptr) return nullptr;
  // A replaced session keeps its age. Otherwise a sender could repeat two old frames in turn and so
  // prevent other sessions of the id.
  const HostTime begun = same != sessions_.end() ? same->begun : sign.at;
  *session = {};
  session->state = State::held;
  session->node_id = sign.node_id;
  session->boot_id = sign.boot_id;
  session->address = sign.from;
  session->begun = begun;
  session->last_arrival = sign.at;
  return session;
}

/// Chooses among the streams with this node id: first by boot id, then by address, then the one
/// silent longest.
NodeStream* NodeTable::stream_for(const NodeSession& session) {
  const auto rank = [&](const NodeStream& stream) {
    const NodeSession& present = sessions_[stream.session];
    return std::tuple(present.boot_id == session.boot_id, present.address == session.address,
                      present.address.host == session.address.host,
                      -present.last_arrival.time_since_epoch());
  };
  NodeStream* best = nullptr;
  for (NodeStream& stream : streams_) {
    if (!stream.used || stream.node_id != session.node_id) continue;
    if (best == nullptr || rank(stream) > rank(*best)) best = &stream;
  }
  return best;
}

/// Returns a free stream, or the stream of the node silent longest if it was silent for a minute.
NodeStream* NodeTable::new_stream(const NodeSession& session, HostTime now) {
  const auto last_arrival = [this](const NodeStream& s) {
    return s.used ? sessions_[s.session].last_arrival : HostTime::min();
  };
  NodeStream& stream = *std::min_element(
      streams_.begin(), streams_.end(),
      [&](const auto& a, const auto& b) { return last_arrival(a) < last_arrival(b); });
  if (stream.used) {
    if (now - last_arrival(stream) <= known_for) {
      if (now < report_too_many_) return nullptr;
      report_too_many_ = now + left_after;
      report(Kind::too_many, session, now);
      return nullptr;
    }
    sessions_[stream.session].state = State::free;
  }
  stream = {};
  stream.used = true;
  stream.number = ++streams_made_;
  stream.node_id = session.node_id;
  return &stream;
}

// Makes the session the present one of the stream.
void NodeTable::enter(NodeSession& session, NodeStream& stream, HostTime now) {
  session.state = State::live;
  session.stream = static_cast<std::size_t>(&stream - streams_.data());
  session.last_arrival = now;
  stream.session = index(session);
  stream.silent = stream.locked = false;
  ++stream.sessions;
}

// Continues a stream of the same node id with this session. If there is none, a new stream begins.
bool NodeTable::admit(NodeSession& session, HostTime now) {
  const bool again = knows_boot(session.node_id, session.boot_id);
  NodeStream* stream = stream_for(session);
  const bool joins = stream == nullptr;
  if (joins) stream = new_stream(session, now);
  if (stream == nullptr) return false;
  // The previous session of the stream is over. Its late datagrams are still recognised.
  if (!joins) {
    sessions_[stream->session].state = State::earlier;
    sessions_[stream->session].replaced = now;
  }
  // The boot id is used again. A different key separates the clocks of the two sessions.
  session.key = session.boot_id | (again ? ++restarts_ << 32 : 0);
  enter(session, *stream, now);
  report(joins ? Kind::joined : again ? Kind::restarted : Kind::started, session, now);
  if (joins) report_name(session, now);
  return true;
}

bool NodeTable::part(NodeSession& session, HostTime now) {
  NodeStream* stream = new_stream(session, now);
  if (stream == nullptr) return false;
  enter(session, *stream, now);
  report(Kind::twins, session, now);
  return true;
}

/// Reports if a joining node had another id before. This is so in two cases: another node has the
/// same boot id, or a silent node had the same address and port.
void NodeTable::report_name(const NodeSession& session, HostTime now) {
  for (const NodeStream& stream : streams_) {
    const NodeSession& other = sessions_[stream.session];
    if (!stream.used || &other == &session || other.node_id == session.node_id) continue;
    const bool moved_in = other.address == session.address && other.last_arrival < session.begun;
    if (other.boot_id != session.boot_id && !moved_in) continue;
    report({Kind::renamed, session.stream, session.node_id, session.boot_id, now, session.address,
            other.node_id});
    return;
  }
}

void NodeTable::tick(HostTime now) {
  for (NodeStream& stream : streams_) {
    if (!stream.used || stream.silent || now - sessions_[stream.session].last_arrival < left_after)
      continue;
    stream.silent = true;
    report(Kind::left, sessions_[stream.session], now);
  }
}

void NodeTable::report(NodeEvent::Kind kind, const NodeSession& session, HostTime at) {
  report({kind, session.stream, session.node_id, session.boot_id, at, session.address});
}

}  // namespace kinalign
