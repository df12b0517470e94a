// SPDX-License-Identifier: Apache-2.0
// Decides about each datagram of the NTP port: answered, limited or refused, with the reason. It
// uses no socket and no clock, so every rule can be tested.
#pragma once

#include "kinalign/capture/net/counts_by.h"
#include "kinalign/capture/net/host_address.h"
#include "kinalign/capture/net/rate_limit.h"
#include "kinalign/capture/ntp/ntp_answer.h"
#include "kinalign/wire/siphash.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace kinalign {

/// The outcome of a datagram; each has exactly one.
enum class NtpOutcome : std::uint8_t {
  answered,
  limited,    // the address asks too often; no answer
  kissed,     // the same, but answered with the kiss RATE; one of 16 such requests
  too_short,  // this and the next three: refusals of decode_request
  wrong_version,
  wrong_mode,
  wrong_trailer,
  from_port_0,    // an answer to port 0 cannot be received
  from_itself,    // sent from the server's own address and port; answering would make a loop
  not_unicast,    // sent to a broadcast or multicast address; many hosts would answer
  clock_stepped,  // the clock was stepped between arrival and answer
  unsent,         // the system did not accept the answer
  from_node,      // an inertial node's datagram; nodes have their own port
};
constexpr std::size_t ntp_outcomes = 13;

/// The same word as in --json: "wrong_version".
std::string_view name_of(NtpOutcome outcome);

/// Datagrams by outcome.
using NtpCounts = CountsBy<NtpOutcome, ntp_outcomes>;

/// A received datagram.
/// Everything that the decision depends on. `to` and `to_port` are the server's own address and
/// port.
struct NtpAsked {
  std::span<const std::uint8_t> bytes;
  bool cut = false;  // the datagram was longer than `bytes`
  HostAddress from{};
  std::uint16_t from_port = 0;
  HostAddress to{};
  std::uint16_t to_port = 0;
  bool unicast = true;
  Time received{};
};

/// The rate limit is the only state that requests can change; it has a fixed size.
class NtpResponder {
 public:
  /// `key`: secret, random in each run. `exempt`: networks whose requests are not limited.
  NtpResponder(const SipHashKey& key, std::vector<AddressBlock> exempt)
      : key_(key), exempt_(std::move(exempt)) {}

  /// Fills `answer` if the outcome is answered or kissed. `now` becomes the transmit stamp, so the
  /// answer must be sent at once. `host_now` is the same moment on the host's axis, for the rate
  /// limit.
  NtpOutcome respond(const NtpAsked& asked, Time now, HostTime host_now,
                     std::span<std::uint8_t, ntp_packet_size> answer);

  void set_state(const NtpServerState& state) { state_ = state; }
  const NtpServerState& state() const { return state_; }

 private:
  RateLimit::Verdict limit(const HostAddress& from, HostTime now);

  SipHashKey key_;
  std::vector<AddressBlock> exempt_;
  RateLimit limit_;
  NtpServerState state_;
};

}  // namespace kinalign
