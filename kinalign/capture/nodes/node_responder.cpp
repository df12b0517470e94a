// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_responder.h"

#include "kinalign/wire/node_reply.h"

#include <cstring>

namespace kinalign {

namespace {

using State = NodeSession::State;

std::uint64_t host_ns(HostTime t) {
  return static_cast<std::uint64_t>(t.time_since_epoch().count());
}

NodeSign sign_of(const NodeArrival& arrival, const DatagramOrigin& origin) {
  return {origin.node_id, origin.boot_id,  arrival.from,
          arrival.h_rx,   origin.sequence, std::nullopt};
}

// Some datagrams that are not accepted get an answer too. A node that has just started, or whose
// frames were delayed, needs an answer that it can echo.
bool is_answered(NodeVerdict verdict) {
  return verdict == NodeVerdict::accepted || verdict == NodeVerdict::held ||
         verdict == NodeVerdict::replayed || verdict == NodeVerdict::earlier_session;
}

}  // namespace

NodeResponder::NodeResponder(const NodeResponderOptions& options)
    : secret_(options.secret), keys_(options.lab_key) {}

NodeMessage NodeResponder::receive(const NodeArrival& arrival) {
  NodeMessage message;
  asked_ = {};
  message.verdict = judge(arrival, message);
  ++counts_.verdicts[message.verdict];
  if (!is_answered(message.verdict)) asked_.by = nullptr;
  // The pace is asked last, so that only frames which may be answered are counted.
  if (asked_.by != nullptr && !asked_.by->pace.ask(arrival.h_rx)) asked_.by = nullptr;
  return message;
}

NodeVerdict NodeResponder::judge(const NodeArrival& arrival, NodeMessage& message) {
  Envelope envelope;
  // All checks that need no key are made first.
  const NodeRefusal refusal = open_envelope(arrival.bytes, envelope);
  message.node_id = envelope.origin.node_id;
  if (refusal != NodeRefusal::none) {
    refuse(refusal, envelope.version, arrival.h_rx);
    return NodeVerdict::refused;
  }
  asked_.h_rx = arrival.h_rx;
  asked_.type = envelope.type;
  asked_.origin = envelope.origin;
  switch (envelope.type) {
    case DatagramType::request:
      return judge_request(arrival, envelope, message);
    case DatagramType::confirm:
      return judge_confirm(arrival, envelope, message);
    default:  // decode refuses the types that only a host sends
      return judge_frame(arrival, envelope, message);
  }
}

// A higher protocol version is reported once, when it is first received.
void NodeResponder::refuse(NodeRefusal refusal, std::uint8_t version, HostTime now) {
  ++counts_.refusals[refusal];
  if (refusal != NodeRefusal::unknown_version || version <= counts_.newest_version) return;
  counts_.newest_version = version;
  table_.report({.kind = NodeEvent::Kind::newer_version, .at = now, .version = version});
}

/// Decodes with the node's key, or with its previous key while that is still valid.
template <class Datagram>
bool NodeResponder::unlock(const Envelope& envelope, const NodeArrival& arrival,
                           Datagram& datagram) {
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
  report_wrong_key(refusal, envelope.origin, arrival);
  return false;
}

/// Forged datagrams can cause this event too, so refused_nodes_ limits its rate.
void NodeResponder::report_wrong_key(NodeRefusal refusal, const DatagramOrigin& origin,
                                     const NodeArrival& arrival) {
  const bool is_key = refusal == NodeRefusal::no_key || refusal == NodeRefusal::no_mac ||
                      refusal == NodeRefusal::wrong_mac;
  if (!is_key || !refused_nodes_.take(refusal, origin.node_id, arrival.h_rx)) return;
  table_.report({.kind = NodeEvent::Kind::wrong_key,
                 .node_id = origin.node_id,
                 .boot_id = origin.boot_id,
                 .at = arrival.h_rx,
                 .address = arrival.from,
                 .refusal = refusal});
}

// An echo proves that the frame is not a replayed recording. The order of checks is: sequence
// number, echo, session.
NodeVerdict NodeResponder::judge_frame(const NodeArrival& arrival, const Envelope& envelope,
                                       NodeMessage& message) {
  if (!unlock(envelope, arrival, frame_)) return NodeVerdict::refused;
  if (frame_.n_tx_us > max_counter_us) return NodeVerdict::wrong_counter;
  NodeSign sign = sign_of(arrival, frame_.origin);
  sign.counter_us = frame_.n_tx_us;
  NodeSession* session = nullptr;
  if (const auto found = find_place(sign, session, message); found != NodeVerdict::accepted) {
    return found;
  }
  const std::int64_t n_tx = session->counter.unwrap(frame_.n_tx_us, sign.at);
  const auto echo = take_echo(*session, n_tx);
  session->counter.take(n_tx, sign.at);
  if (const auto taken =
          take_session(*session, sign, echo ? std::optional(echo->h_tx) : std::nullopt);
      taken != NodeVerdict::accepted) {
    return taken;
  }
  message.exchange = Exchange{session->key, node_time(n_tx), sign.at, echo};
  keep(std::span(frame_.samples).first(frame_.sample_count), n_tx, message);
  accept(*session, sign, message);
  if (frame_.has_battery) table_.stream(session->stream).battery_mv = frame_.battery_mv;
  return NodeVerdict::accepted;
}

// A request has no echo. Without keys, a request with a new boot id admits its session. In all
// other cases only a confirm admits a new session.
NodeVerdict NodeResponder::judge_request(const NodeArrival& arrival, const Envelope& envelope,
                                         NodeMessage& message) {
  ClocklessRequest request;
  if (!unlock(envelope, arrival, request)) return NodeVerdict::refused;
  const NodeSign sign = sign_of(arrival, request.origin);
  NodeSession* session = nullptr;
  if (const auto found = find_place(sign, session, message); found != NodeVerdict::accepted) {
    return found;
  }
  if (const auto taken = take_session(*session, sign, std::nullopt);
      taken != NodeVerdict::accepted) {
    return taken;
  }
  message.clockless = ClocklessExchange{message.frame, sign.at, {}, std::nullopt, session->key};
  keep(std::span(&request.sample, request.has_sample ? 1 : 0), std::nullopt, message);
  accept(*session, sign, message);
  if (request.has_battery) table_.stream(session->stream).battery_mv = request.battery_mv;
  return NodeVerdict::accepted;
}

// A confirm names an answer of this run, which proves that it is not a replayed recording. The
// times come from the table of answers. If the copies in the confirm differ, they are only counted.
NodeVerdict NodeResponder::judge_confirm(const NodeArrival& arrival, const Envelope& envelope,
                                         NodeMessage& message) {
  ClocklessConfirm confirm;
  if (!unlock(envelope, arrival, confirm)) return NodeVerdict::refused;
  const NodeSign sign = sign_of(arrival, confirm.origin);
  NodeSession* session = table_.session_of(sign);
  GivenAnswer answer;
  const bool known = session != nullptr &&
                     session->answers.find(confirm.origin.sequence, confirm.times.nonce, answer) ==
                         EchoVerdict::taken;
  if (!known) return NodeVerdict::unknown_answer;
  if (confirm.times.t2_ns != host_ns(answer.t2) || confirm.times.t3_ns != host_ns(answer.t3)) {
    ++counts_.wrong_copies;
  }
  if (const auto taken = take_session(*session, sign, answer.t3); taken != NodeVerdict::accepted) {
    return taken;
  }
  message.frame = answer.frame;
  message.stream = session->stream;
  message.clockless = ClocklessExchange{answer.frame, answer.t2, answer.t3, sign.at, session->key};
  return NodeVerdict::accepted;
}

// Finds the session that the datagram continues, or makes a new session that is held.
NodeVerdict NodeResponder::find_session(const NodeSign& sign, NodeSession*& session) {
  session = table_.session_of(sign);
  if (session != nullptr) return NodeVerdict::accepted;
  // Only unknown addresses are limited; a known address may begin any number of sessions.
  if (!table_.knows_address(sign.from.host, sign.at)) {
    const std::uint64_t hash = siphash_2_4(secret_, address_prefix(sign.from.host));
    if (unknown_senders_.ask(hash, sign.at) != RateLimit::Verdict::answer)
      return NodeVerdict::limited;
  }
  session = table_.hold(sign);
  return session != nullptr ? NodeVerdict::accepted : NodeVerdict::no_room;
}

/// Finds the session of a datagram that may be answered, and registers the datagram's sequence
/// number.
NodeVerdict NodeResponder::find_place(const NodeSign& sign, NodeSession*& session,
                                      NodeMessage& message) {
  if (const auto found = find_session(sign, session); found != NodeVerdict::accepted) return found;
  Counter& sequences = session->sequences;
  // The first number gets an offset of 2^32, so that earlier numbers are not negative.
  const std::int64_t number =
      sequences.empty() ? (std::int64_t{1} << 32) + sign.sequence : sequences.unwrap(sign.sequence);
  const Counter::Place place = sequences.place_of(number);
  if (place == Counter::Place::duplicate) return NodeVerdict::duplicate;
  if (place == Counter::Place::behind) return NodeVerdict::replayed;
  sequences.take(number);
  message.frame = asked_.frame = static_cast<std::uint64_t>(number);
  message.late = place == Counter::Place::late;
  asked_.by = session;
  return NodeVerdict::accepted;
}

/// Admits the session if necessary. `echoed` is the departure of the answer that this datagram
/// names.
NodeVerdict NodeResponder::take_session(NodeSession& session, const NodeSign& sign,
                                        std::optional<HostTime> echoed) {
  session.last_arrival = sign.at;
  if (session.state == State::live) return NodeVerdict::accepted;
  if (session.state == State::earlier) {
    // The node id has a newer session. Either the datagram was sent before the node started again,
    // or another node has the same id. A restarted node has a new boot id, so a datagram of this
    // session that names a later answer comes from another node.
    if (!echoed || *echoed <= session.replaced) return NodeVerdict::earlier_session;
    return table_.part(session, sign.at) ? NodeVerdict::accepted : NodeVerdict::no_room;
  }
  // Without a key, the first datagram with new ids admits the session, because there is nothing to
  // prove.
  const bool again = table_.knows_boot(session.node_id, session.boot_id);
  if (!echoed && (keys_.keyed() || again)) {
    return again ? NodeVerdict::replayed : NodeVerdict::held;
  }
  return table_.admit(session, sign.at) ? NodeVerdict::accepted : NodeVerdict::no_room;
}

// An echo is counted as `future` if its arrival lies after the frame's departure or is too large
// for a counter.
std::optional<Exchange::Echo> NodeResponder::take_echo(NodeSession& session, std::int64_t n_tx_us) {
  EchoVerdict verdict = EchoVerdict::none;
  GivenAnswer answer;
  std::int64_t n_rx = 0;
  if (frame_.has_echo) {
    const bool future = frame_.echo.n_rx_us > max_counter_us;
    n_rx = future ? 0 : NodeCounter::unwrap_before(frame_.echo.n_rx_us, n_tx_us);
    verdict = future || n_rx > n_tx_us
                  ? EchoVerdict::future
                  : session.answers.find(frame_.echo.reply_sequence, frame_.echo.nonce, answer);
  }
  ++counts_.echoes[verdict];
  if (verdict != EchoVerdict::taken) return std::nullopt;
  return Exchange::Echo{node_time(n_rx), answer.t3};
}

/// Stores the samples with their counter stamps. `n_tx_us` is absent if the node has no counter.
void NodeResponder::keep(std::span<const NodeSample> samples, std::optional<std::int64_t> n_tx_us,
                         NodeMessage& message) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const NodeTime n = n_tx_us ? node_time(*n_tx_us - samples[i].age_us) : NodeTime{};
    readings_[i] = {n, samples[i], faults(samples[i])};
  }
  message.readings = std::span(readings_).first(samples.size());
}

// Counts an accepted datagram and reports if its node has returned or has a new address.
void NodeResponder::accept(NodeSession& session, const NodeSign& sign, NodeMessage& message) {
  NodeStream& stream = table_.stream(session.stream);
  message.stream = session.stream;
  session.old_key = asked_.old_key;
  ++session.accepted;
  if (stream.silent) table_.report(NodeEvent::Kind::returned, session, sign.at);
  stream.silent = false;
  // A late datagram may come from the previous address of the node.
  if (message.late || session.address == sign.from) return;
  session.address = sign.from;
  table_.report(NodeEvent::Kind::moved, session, sign.at);
}

std::span<const std::uint8_t> NodeResponder::answer(HostTime h_tx, std::span<std::uint8_t> out) {
  if (asked_.by == nullptr) return {};
  NodeSession& session = *asked_.by;
  asked_.by = nullptr;
  std::array<std::uint8_t, sizeof nonces_> number{};
  std::memcpy(number.data(), &++nonces_, number.size());
  // The nonce is a counter hashed with the secret. It does not repeat soon and can't be guessed.
  const auto nonce = static_cast<std::uint32_t>(siphash_2_4(secret_, number));
  const bool clockless = asked_.type == DatagramType::request;
  const std::uint32_t sequence = clockless ? asked_.origin.sequence : session.next_reply++;
  session.answers.add({sequence, nonce, asked_.h_rx, h_tx, asked_.frame});
  ++counts_.answers;
  const MacKey* key = asked_.key ? &*asked_.key : nullptr;
  if (clockless) {
    const ClocklessTimes times{nonce, host_ns(asked_.h_rx), host_ns(h_tx)};
    return encode(ClocklessAnswer{asked_.origin, times}, key, out);
  }
  const bool locked = session.state == State::live && table_.stream(session.stream).locked;
  return encode(NodeReply{asked_.origin, locked, sequence, nonce, host_ns(h_tx)}, key, out);
}

}  // namespace kinalign
