// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_table.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace kinalign {

namespace {

using State = NodeLife::State;
using Kind = NodeEvent::Kind;

// a frame may be this much older than a frame that arrived before it
constexpr std::int64_t most_back_us = 1'000'000;
constexpr std::int64_t most_ahead_us = 2'000'000;  // the limit for the same node at another address
// An address counts as known, and a silent node's stream is not reused, for this long.
constexpr Duration known_for = std::chrono::seconds(60);
constexpr Duration left_after = std::chrono::seconds(10);
constexpr Duration held_for = std::chrono::seconds(1);  // a held life is kept at least this long
constexpr std::size_t most_held = 4;                    // held lives of one node id

bool has_ids(const NodeLife& life, std::uint32_t node_id, std::uint32_t boot_id) {
  return life.state != State::free && life.node_id == node_id && life.boot_id == boot_id;
}

/// Returns whether a datagram with the same ids may continue this life, judged by its counter,
/// sequence number and address.
bool continues(const NodeLife& life, const NodeSign& sign) {
  if (!sign.counter_us) return true;
  const std::int64_t n = life.counter.widened(*sign.counter_us, sign.at);
  const std::int64_t behind = life.counter.behind_us(n);
  if (behind > most_back_us) return false;
  // Both counter and sequence have started again if a later reading comes with an earlier number,
  // or with a number far behind. The counter then only seems to continue: it was taken for a 32-bit
  // counter that wrapped, or it has run nearly as long as before.
  if (behind < 0 && !life.sequences.is_ahead(sign.sequence)) return false;
  if (life.sequences.place_of(sign.sequence) == SequenceWindow::Place::behind) return false;
  // If the address is unchanged, a jump ahead is a step of the node's counter. The clock model will
  // detect it.
  return life.address == sign.from || life.counter.ahead_us(n, sign.at) <= most_ahead_us;
}

/// Orders the lives that a datagram may continue; a greater value is more likely. A counter that
/// starts again passes the reading at which its earlier life ended. The present life at the same
/// address is then the right one, otherwise the life that predicted the counter.
auto likelihood(const NodeLife& life, const NodeSign& sign) {
  const bool live = life.state == State::live, here = life.address == sign.from;
  bool foretold = true;
  if (sign.counter_us) {
    const std::int64_t n = life.counter.widened(*sign.counter_us, sign.at);
    foretold = std::abs(life.counter.ahead_us(n, sign.at)) <= most_ahead_us;
  }
  return std::tuple(foretold || (live && here), here, live);
}

}  // namespace

std::size_t NodeTable::index(const NodeLife& life) const {
  return static_cast<std::size_t>(&life - lives_.data());
}

NodeLife* NodeTable::life_of(const NodeSign& sign) {
  NodeLife* best = nullptr;
  for (NodeLife& life : lives_) {
    if (!has_ids(life, sign.node_id, sign.boot_id) || !continues(life, sign)) continue;
    if (best == nullptr || likelihood(life, sign) > likelihood(*best, sign)) best = &life;
  }
  return best;
}

bool NodeTable::knows_boot(std::uint32_t node_id, std::uint32_t boot_id) const {
  return std::any_of(lives_.begin(), lives_.end(), [&](const NodeLife& life) {
    return has_ids(life, node_id, boot_id) && life.state != State::held;
  });
}

bool NodeTable::knows_address(const HostAddress& host, HostTime now) const {
  return std::any_of(lives_.begin(), lives_.end(), [&](const NodeLife& life) {
    return life.state == State::live && life.address.host == host && now - life.heard <= known_for;
  });
}

/// Returns a free place, or else that of the life silent longest among those that are not the
/// present life of a stream. If a node has most_held held lives already, its oldest held life is
/// replaced.
NodeLife* NodeTable::room_for_life(const NodeSign& sign) {
  NodeLife* oldest = nullptr;
  NodeLife* oldest_held = nullptr;
  std::size_t held = 0;
  for (NodeLife& life : lives_) {
    const bool own = life.state == State::held && life.node_id == sign.node_id;
    if (own) ++held;
    if (own && (oldest_held == nullptr || life.begun < oldest_held->begun)) oldest_held = &life;
    if (life.state == State::live) continue;
    const auto age = [](const NodeLife& l) { return std::pair(l.state != State::free, l.heard); };
    if (oldest == nullptr || age(life) < age(*oldest)) oldest = &life;
  }
  NodeLife* room = held >= most_held ? oldest_held : oldest;
  const bool young =
      room != nullptr && room->state == State::held && sign.at - room->begun < held_for;
  return young ? nullptr : room;
}

NodeLife* NodeTable::hold(const NodeSign& sign) {
  const auto same = std::find_if(lives_.begin(), lives_.end(), [&](const NodeLife& life) {
    return has_ids(life, sign.node_id, sign.boot_id) && life.state == State::held &&
           life.address == sign.from;
  });
  NodeLife* life = same != lives_.end() ? &*same : room_for_life(sign);
  if (life == nullptr) return nullptr;
  // A replaced life keeps its age. Otherwise a sender that alternates two frames of an old life
  // would keep it young, and so keep out other lives of its id.
  const HostTime begun = same != lives_.end() ? same->begun : sign.at;
  *life = {};
  life->state = State::held;
  life->node_id = sign.node_id;
  life->boot_id = sign.boot_id;
  life->address = sign.from;
  life->begun = begun;
  life->heard = sign.at;
  return life;
}

/// Chooses among the streams with this node id: by boot id, then by address, then by longest
/// silence.
NodeStream* NodeTable::stream_for(const NodeLife& life) {
  const auto rank = [&](const NodeStream& stream) {
    const NodeLife& present = lives_[stream.life];
    return std::tuple(present.boot_id == life.boot_id, present.address == life.address,
                      present.address.host == life.address.host, -present.heard.time_since_epoch());
  };
  NodeStream* best = nullptr;
  for (NodeStream& stream : streams_) {
    if (!stream.used || stream.node_id != life.node_id) continue;
    if (best == nullptr || rank(stream) > rank(*best)) best = &stream;
  }
  return best;
}

/// Returns a free stream, or that of the node silent longest if it was silent for a minute.
NodeStream* NodeTable::new_stream(const NodeLife& life, HostTime now) {
  const auto heard = [this](const NodeStream& s) {
    return s.used ? lives_[s.life].heard : HostTime::min();
  };
  NodeStream& stream =
      *std::min_element(streams_.begin(), streams_.end(),
                        [&](const auto& a, const auto& b) { return heard(a) < heard(b); });
  if (stream.used) {
    if (now - heard(stream) <= known_for) {
      if (now < tell_too_many_) return nullptr;
      tell_too_many_ = now + left_after;
      tell(Kind::too_many, life, now);
      return nullptr;
    }
    lives_[stream.life].state = State::free;
  }
  stream = {};
  stream.used = true;
  stream.number = ++streams_made_;
  stream.node_id = life.node_id;
  return &stream;
}

void NodeTable::enter(NodeLife& life, NodeStream& stream, HostTime now) {
  life.state = State::live;
  life.stream = static_cast<std::size_t>(&stream - streams_.data());
  life.heard = now;
  stream.life = index(life);
  stream.silent = stream.locked = false;
  ++stream.lives;
}

// A stream of the same node id continues with this life. If there is none, a new stream begins.
bool NodeTable::admit(NodeLife& life, HostTime now) {
  const bool again = knows_boot(life.node_id, life.boot_id);
  NodeStream* stream = stream_for(life);
  const bool joins = stream == nullptr;
  if (joins) stream = new_stream(life, now);
  if (stream == nullptr) return false;
  if (!joins) {
    lives_[stream->life].state = State::earlier;
    lives_[stream->life].replaced = now;
  }
  life.key = life.boot_id | (again ? ++restarts_ << 32 : 0);
  enter(life, *stream, now);
  tell(joins ? Kind::joined : again ? Kind::restarted : Kind::started, life, now);
  if (joins) tell_name(life, now);
  return true;
}

bool NodeTable::part(NodeLife& life, HostTime now) {
  NodeStream* stream = new_stream(life, now);
  if (stream == nullptr) return false;
  enter(life, *stream, now);
  tell(Kind::twins, life, now);
  return true;
}

/// Reports if a joining node was known by another id. It was if it has that node's boot id, or if
/// it has that node's address and port and the other node has fallen silent.
void NodeTable::tell_name(const NodeLife& life, HostTime now) {
  for (const NodeStream& stream : streams_) {
    const NodeLife& other = lives_[stream.life];
    if (!stream.used || &other == &life || other.node_id == life.node_id) continue;
    const bool moved_in = other.address == life.address && other.heard < life.begun;
    if (other.boot_id != life.boot_id && !moved_in) continue;
    tell(
        {Kind::renamed, life.stream, life.node_id, life.boot_id, now, life.address, other.node_id});
    return;
  }
}

void NodeTable::tick(HostTime now) {
  for (NodeStream& stream : streams_) {
    if (!stream.used || stream.silent || now - lives_[stream.life].heard < left_after) continue;
    stream.silent = true;
    tell(Kind::left, lives_[stream.life], now);
  }
}

void NodeTable::tell(NodeEvent::Kind kind, const NodeLife& life, HostTime at) {
  tell({kind, life.stream, life.node_id, life.boot_id, at, life.address, std::nullopt});
}

}  // namespace kinalign
