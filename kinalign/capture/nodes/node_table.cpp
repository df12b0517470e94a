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

constexpr std::int64_t most_back_us = 1'000'000;   // of a frame behind one that was sent later
constexpr std::int64_t most_ahead_us = 2'000'000;  // of the same node at another address
constexpr Duration known_for = std::chrono::seconds(60);
constexpr Duration left_after = std::chrono::seconds(10);
constexpr Duration held_for = std::chrono::seconds(1);  // at least, if others want the room
constexpr std::size_t most_held = 4;                    // lives of one node id

bool has_ids(const NodeLife& life, std::uint32_t node_id, std::uint32_t boot_id) {
  return life.state != State::free && life.node_id == node_id && life.boot_id == boot_id;
}

/// By counter, number and address, of one that has the same ids.
bool continues(const NodeLife& life, const NodeSign& sign) {
  if (!sign.counter_us) return true;
  const std::int64_t n = life.counter.widened(*sign.counter_us, sign.at);
  const std::int64_t behind = life.counter.behind_us(n);
  if (behind > most_back_us) return false;
  // A later reading under an earlier number, or a number of long ago within a second: both began
  // anew, and the counter, taken for a narrow one that has gone round or being nearly as old, seems
  // to go on.
  if (behind < 0 && !life.sequences.is_ahead(sign.sequence)) return false;
  if (life.sequences.place_of(sign.sequence) == SequenceWindow::Place::behind) return false;
  // From where it always came a jump ahead is a step of its counter, which the clock will see.
  return life.address == sign.from || life.counter.ahead_us(n, sign.at) <= most_ahead_us;
}

/// Which of the lives that a datagram may continue it most likely does; more is better. A counter
/// that goes back and climbs again passes where its earlier life ended: the present life at the
/// same address is then the one, else that which foretold the counter.
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

/// A free place, else that of the longest silent life that is not the present one of a stream. A
/// node of which as many lives are held as may be has no more: its oldest held one makes room.
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
  // As old as before: who sends two frames of an old life in turn would keep it young, and others
  // of its id out.
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

/// Of the streams with its node id: the one whose boot id it has, or its address, or that was
/// silent for longest.
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

/// A free one, or that of the node which was silent for longest, if that was for a minute.
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

/// Whether a node that joins was known by another id: it has its boot id, or its address and port
/// since it fell silent.
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
