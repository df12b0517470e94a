// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_desk.h"

#include "kinalign/wire/node_reply.h"

#include <cstring>

namespace kinalign {

namespace {

using State = NodeLife::State;
using Found = AnswerTable::Found;

std::uint64_t host_ns(HostTime t) {
  return static_cast<std::uint64_t>(t.time_since_epoch().count());
}

NodeSign sign_of(const NodeArrival& arrival, const DatagramOrigin& origin) {
  return {origin.node_id, origin.boot_id,  arrival.from,
          arrival.h_rx,   origin.sequence, std::nullopt};
}

bool is_answered(NodeVerdict verdict) {
  return verdict == NodeVerdict::accepted || verdict == NodeVerdict::held ||
         verdict == NodeVerdict::replayed || verdict == NodeVerdict::earlier_life;
}

}  // namespace

NodeDesk::NodeDesk(const NodeDeskOptions& options)
    : secret_(options.secret), keys_(options.lab_key) {}

NodeNews NodeDesk::receive(const NodeArrival& arrival) {
  NodeNews news;
  asked_ = {};
  news.verdict = judge(arrival, news);
  ++counts_.verdicts[news.verdict];
  if (!is_answered(news.verdict)) asked_.by = nullptr;
  if (asked_.by != nullptr && !asked_.by->pace.ask(arrival.h_rx)) asked_.by = nullptr;
  return news;
}

NodeVerdict NodeDesk::judge(const NodeArrival& arrival, NodeNews& news) {
  Envelope envelope;
  const NodeRefusal refusal = open_envelope(arrival.bytes, envelope);
  news.node_id = envelope.origin.node_id;
  if (refusal != NodeRefusal::none) {
    refuse(refusal, envelope.version, arrival.h_rx);
    return NodeVerdict::refused;
  }
  asked_.h_rx = arrival.h_rx;
  asked_.type = envelope.type;
  asked_.origin = envelope.origin;
  switch (envelope.type) {
    case DatagramType::request:
      return judge_request(arrival, envelope, news);
    case DatagramType::confirm:
      return judge_confirm(arrival, envelope, news);
    default:  // decode refuses types that only a host sends
      return judge_frame(arrival, envelope, news);
  }
}

// A higher protocol version is reported once, when it is first received.
void NodeDesk::refuse(NodeRefusal refusal, std::uint8_t version, HostTime now) {
  ++counts_.refusals[refusal];
  if (refusal != NodeRefusal::unknown_version || version <= counts_.newest_version) return;
  counts_.newest_version = version;
  NodeEvent event;
  event.kind = NodeEvent::Kind::newer_version;
  event.at = now;
  event.version = version;
  table_.tell(event);
}

/// Decodes with the node's key, or with its previous key while that is still valid.
template <class Datagram>
bool NodeDesk::unlock(const Envelope& envelope, const NodeArrival& arrival, Datagram& datagram) {
  const std::uint32_t id = envelope.origin.node_id;
  const HostTime now = arrival.h_rx;
  const MacKey* key = keys_.key_of(id);
  NodeRefusal refusal = decode(envelope, key, datagram);
  const MacKey* old = refusal == NodeRefusal::wrong_mac ? keys_.old_key_of(id, now) : nullptr;
  if (old != nullptr) {
    refusal = decode(envelope, old, datagram);
    if (refusal == NodeRefusal::none) ++counts_.old_key;
    key = old;
  }
  asked_.key = key != nullptr ? std::optional(*key) : std::nullopt;
  asked_.old_key = old != nullptr;
  if (refusal == NodeRefusal::none) return true;
  refuse(refusal, envelope.version, now);
  tell_wrong_key(refusal, envelope.origin, arrival);
  return false;
}

/// Anyone can cause this event with forged datagrams, so refused_nodes_ limits its rate.
void NodeDesk::tell_wrong_key(NodeRefusal refusal, const DatagramOrigin& origin,
                              const NodeArrival& arrival) {
  const bool is_key = refusal == NodeRefusal::no_key || refusal == NodeRefusal::no_mac ||
                      refusal == NodeRefusal::wrong_mac;
  if (!is_key || !refused_nodes_.take(refusal, origin.node_id, arrival.h_rx)) return;
  NodeEvent event;
  event.kind = NodeEvent::Kind::wrong_key;
  event.node_id = origin.node_id;
  event.boot_id = origin.boot_id;
  event.at = arrival.h_rx;
  event.address = arrival.from;
  event.refusal = refusal;
  table_.tell(event);
}

// The sequence number is checked before the echo, and the echo before the life is admitted: an echo
// proves that the frame is not a recording played back.
NodeVerdict NodeDesk::judge_frame(const NodeArrival& arrival, const Envelope& envelope,
                                  NodeNews& news) {
  if (!unlock(envelope, arrival, frame_)) return NodeVerdict::refused;
  if (frame_.n_tx_us > most_counter_us) return NodeVerdict::wrong_counter;
  NodeSign sign = sign_of(arrival, frame_.origin);
  sign.counter_us = frame_.n_tx_us;
  NodeLife* life = nullptr;
  if (const auto found = find_place(sign, frame_.origin.sequence, life, news);
      found != NodeVerdict::accepted) {
    return found;
  }
  const std::int64_t n_tx = life->counter.widened(frame_.n_tx_us, sign.at);
  const auto echo = take_echo(*life, n_tx);
  const bool newest = life->counter.behind_us(n_tx) <= 0;
  life->counter.take(n_tx, sign.at);
  if (const auto taken = take_life(*life, sign, echo ? std::optional(echo->h_tx) : std::nullopt);
      taken != NodeVerdict::accepted) {
    return taken;
  }
  news.exchange = Exchange{life->key, node_time(n_tx), sign.at, echo};
  keep(std::span(frame_.samples).first(frame_.sample_count), n_tx, news);
  accept(*life, sign, newest, news);
  if (frame_.has_battery) table_.stream(life->stream).battery_mv = frame_.battery_mv;
  return NodeVerdict::accepted;
}

// A request has no echo. A new life is therefore admitted only by a confirm, unless no key is used
// and the boot id is new.
NodeVerdict NodeDesk::judge_request(const NodeArrival& arrival, const Envelope& envelope,
                                    NodeNews& news) {
  ClocklessRequest request;
  if (!unlock(envelope, arrival, request)) return NodeVerdict::refused;
  const NodeSign sign = sign_of(arrival, request.origin);
  NodeLife* life = nullptr;
  if (const auto found = find_place(sign, request.origin.sequence, life, news);
      found != NodeVerdict::accepted) {
    return found;
  }
  if (const auto taken = take_life(*life, sign, std::nullopt); taken != NodeVerdict::accepted) {
    return taken;
  }
  news.clockless = ClocklessExchange{news.frame, sign.at, {}, std::nullopt, life->key};
  keep(std::span(&request.sample, request.has_sample ? 1 : 0), std::nullopt, news);
  accept(*life, sign, news.frame == life->sequences.newest(), news);
  if (request.has_battery) table_.stream(life->stream).battery_mv = request.battery_mv;
  return NodeVerdict::accepted;
}

// A confirm names an answer of this run and so proves that it is not a recording played back. The
// times come from the table of answers; a wrong copy of them is only counted.
NodeVerdict NodeDesk::judge_confirm(const NodeArrival& arrival, const Envelope& envelope,
                                    NodeNews& news) {
  ClocklessConfirm confirm;
  if (!unlock(envelope, arrival, confirm)) return NodeVerdict::refused;
  const NodeSign sign = sign_of(arrival, confirm.origin);
  NodeLife* life = table_.life_of(sign);
  GivenAnswer answer;
  const bool known =
      life != nullptr &&
      life->answers.find(confirm.origin.sequence, confirm.times.nonce, answer) == Found::now;
  if (!known) return NodeVerdict::unknown_answer;
  if (confirm.times.t2_ns != host_ns(answer.t2) || confirm.times.t3_ns != host_ns(answer.t3)) {
    ++counts_.wrong_copies;
  }
  if (const auto taken = take_life(*life, sign, answer.t3); taken != NodeVerdict::accepted) {
    return taken;
  }
  news.frame = answer.frame;
  news.stream = life->stream;
  news.clockless = ClocklessExchange{answer.frame, answer.t2, answer.t3, sign.at, life->key};
  return NodeVerdict::accepted;
}

NodeVerdict NodeDesk::find_life(const NodeSign& sign, NodeLife*& life) {
  life = table_.life_of(sign);
  if (life != nullptr) return NodeVerdict::accepted;
  if (!table_.knows_address(sign.from.host, sign.at)) {
    const std::uint64_t hash = siphash_2_4(secret_, stranger(sign.from.host));
    if (strangers_.ask(hash, sign.at) != RateLimit::Verdict::answer) return NodeVerdict::limited;
  }
  life = table_.hold(sign);
  return life != nullptr ? NodeVerdict::accepted : NodeVerdict::no_room;
}

/// Finds the life of a datagram that may be answered, and takes the datagram's sequence number.
NodeVerdict NodeDesk::find_place(const NodeSign& sign, std::uint32_t sequence, NodeLife*& life,
                                 NodeNews& news) {
  if (const auto found = find_life(sign, life); found != NodeVerdict::accepted) return found;
  const auto place = life->sequences.place_of(sequence);
  if (place == SequenceWindow::Place::seen) return NodeVerdict::duplicate;
  if (place == SequenceWindow::Place::behind) return NodeVerdict::replayed;
  news.frame = asked_.frame = life->sequences.take(sequence);
  asked_.by = life;
  return NodeVerdict::accepted;
}

/// Admits the life if necessary. `echoed` is the time when the answer that this datagram names was
/// sent.
NodeVerdict NodeDesk::take_life(NodeLife& life, const NodeSign& sign,
                                std::optional<HostTime> echoed) {
  life.heard = sign.at;
  if (life.state == State::live) return NodeVerdict::accepted;
  if (life.state == State::earlier) {
    // The datagram was sent before its node started again, or another node has the same id. Only
    // another node can have received an answer that was sent after the restart.
    if (!echoed || *echoed <= life.replaced) return NodeVerdict::earlier_life;
    return table_.part(life, sign.at) ? NodeVerdict::accepted : NodeVerdict::no_room;
  }
  const bool again = table_.knows_boot(life.node_id, life.boot_id);
  if (!echoed && (keys_.keyed() || again)) {
    return again ? NodeVerdict::replayed : NodeVerdict::held;
  }
  return table_.admit(life, sign.at) ? NodeVerdict::accepted : NodeVerdict::no_room;
}

// An echo whose arrival lies after the frame's own departure, or beyond any counter, is counted as
// `future`.
std::optional<Exchange::Echo> NodeDesk::take_echo(NodeLife& life, std::int64_t n_tx_us) {
  EchoVerdict verdict = EchoVerdict::none;
  GivenAnswer answer;
  std::int64_t n_rx = 0;
  if (frame_.has_echo) {
    const bool future = frame_.echo.n_rx_us > most_counter_us;
    n_rx = future ? 0 : life.counter.widened_before(frame_.echo.n_rx_us, n_tx_us);
    verdict = future || n_rx > n_tx_us ? EchoVerdict::future
                                       : echo_verdict(life.answers.find(frame_.echo.reply_sequence,
                                                                        frame_.echo.nonce, answer));
  }
  ++counts_.echoes[verdict];
  if (verdict != EchoVerdict::taken) return std::nullopt;
  return Exchange::Echo{node_time(n_rx), answer.t3};
}

/// Stores the samples with their counter stamps. `n_tx_us` is absent if the node has no counter.
void NodeDesk::keep(std::span<const NodeSample> samples, std::optional<std::int64_t> n_tx_us,
                    NodeNews& news) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const NodeTime n = n_tx_us ? node_time(*n_tx_us - samples[i].age_us) : NodeTime{};
    readings_[i] = {n, samples[i], faults(samples[i])};
  }
  news.readings = std::span(readings_).first(samples.size());
}

void NodeDesk::accept(NodeLife& life, const NodeSign& sign, bool newest, NodeNews& news) {
  NodeStream& stream = table_.stream(life.stream);
  news.stream = life.stream;
  life.old_key = asked_.old_key;
  ++life.accepted;
  if (stream.silent) table_.tell(NodeEvent::Kind::returned, life, sign.at);
  stream.silent = false;
  if (!newest || life.address == sign.from) return;
  life.address = sign.from;
  table_.tell(NodeEvent::Kind::moved, life, sign.at);
}

std::span<const std::uint8_t> NodeDesk::answer(HostTime h_tx, std::span<std::uint8_t> out) {
  if (asked_.by == nullptr) return {};
  NodeLife& life = *asked_.by;
  asked_.by = nullptr;
  std::array<std::uint8_t, sizeof nonces_> number{};
  std::memcpy(number.data(), &++nonces_, number.size());
  const auto nonce = static_cast<std::uint32_t>(siphash_2_4(secret_, number));
  const bool clockless = asked_.type == DatagramType::request;
  const std::uint32_t sequence = clockless ? asked_.origin.sequence : life.next_reply++;
  life.answers.add({sequence, nonce, asked_.h_rx, h_tx, asked_.frame});
  ++counts_.answers;
  const MacKey* key = asked_.key ? &*asked_.key : nullptr;
  if (clockless) {
    const ClocklessTimes times{nonce, host_ns(asked_.h_rx), host_ns(h_tx)};
    return encode(ClocklessAnswer{asked_.origin, times}, key, out);
  }
  const bool locked = life.state == State::live && table_.stream(life.stream).locked;
  return encode(NodeReply{asked_.origin, locked, sequence, nonce, host_ns(h_tx)}, key, out);
}

}  // namespace kinalign
