// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/ntp_responder.h"

#include "kinalign/wire/node_datagram.h"

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

constexpr std::array<std::string_view, ntp_outcomes> names{
    "answered",      "limited",       "kissed",      "too_short",   "wrong_version",
    "wrong_mode",    "wrong_trailer", "from_port_0", "from_itself", "not_unicast",
    "clock_stepped", "unsent",        "from_node"};

/// The outcome that counts a refusal of decode_request.
NtpOutcome outcome_of(NtpRefusal refusal) {
  switch (refusal) {
    case NtpRefusal::none:
      return NtpOutcome::answered;
    case NtpRefusal::too_short:
      return NtpOutcome::too_short;
    case NtpRefusal::wrong_version:
      return NtpOutcome::wrong_version;
    case NtpRefusal::wrong_mode:
      return NtpOutcome::wrong_mode;
    case NtpRefusal::wrong_trailer:
      return NtpOutcome::wrong_trailer;
  }
  return NtpOutcome::wrong_trailer;
}

/// Judges a datagram by its addresses alone, before its bytes are read.
NtpOutcome outcome_of_way(const NtpAsked& asked) {
  if (!asked.unicast) return NtpOutcome::not_unicast;
  if (asked.from_port == 0) return NtpOutcome::from_port_0;
  const bool itself = asked.from_port == asked.to_port && asked.from == asked.to;
  return itself ? NtpOutcome::from_itself : NtpOutcome::answered;
}

// A node that sends to the wrong port gets its own outcome, so the user can see the mistake.
bool is_from_node(std::span<const std::uint8_t> bytes) {
  Envelope envelope;
  return open_envelope(bytes, envelope) == NodeRefusal::none;
}

}  // namespace

std::string_view name_of(NtpOutcome outcome) { return names[static_cast<std::size_t>(outcome)]; }

RateLimit::Verdict NtpResponder::limit(const HostAddress& from, HostTime now) {
  const bool exempt =
      std::any_of(exempt_.begin(), exempt_.end(),
                  [&from](const AddressBlock& network) { return network.has(from); });
  return exempt ? RateLimit::Verdict::answer
                : limit_.ask(siphash_2_4(key_, address_prefix(from)), now);
}

// The cheap checks come first; the rate limit counts only valid requests.
NtpOutcome NtpResponder::respond(const NtpAsked& asked, Time now, HostTime host_now,
                                 std::span<std::uint8_t, ntp_packet_size> answer) {
  const NtpOutcome way = outcome_of_way(asked);
  if (way != NtpOutcome::answered) return way;
  if (is_from_node(asked.bytes)) return NtpOutcome::from_node;
  NtpPacket request;
  const NtpOutcome read = outcome_of(decode_request(asked.bytes, request));
  if (read != NtpOutcome::answered) return read;
  if (asked.cut) return NtpOutcome::wrong_trailer;
  const RateLimit::Verdict verdict = limit(asked.from, host_now);
  if (verdict == RateLimit::Verdict::drop) return NtpOutcome::limited;
  // The stamp is made after the rate limit, because a clock step is no reason to answer more often.
  const auto transmit = transmit_stamp(asked.received, now);
  if (!transmit) return NtpOutcome::clock_stepped;
  const bool kiss = verdict == RateLimit::Verdict::kiss;
  const auto make = kiss ? ntp_kiss_rate : ntp_answer;
  const auto bytes = encode(make(request, asked.received, *transmit, state_));
  std::copy(bytes.begin(), bytes.end(), answer.begin());
  return kiss ? NtpOutcome::kissed : NtpOutcome::answered;
}

}  // namespace kinalign
