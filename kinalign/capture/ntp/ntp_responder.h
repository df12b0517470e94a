// SPDX-License-Identifier: Apache-2.0
// Decides about each datagram of the NTP port: answer, limit or refuse, with the reason. This code
// uses no socket and no clock, so tests can reach every rule.
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

/// The outcome for a datagram. Each datagram has exactly one outcome.
enum class NtpOutcome : std::uint8_t {
  answered,
  limited,    // the address asks too often; no answer
  kissed,     // the address asks too often; this request got the kiss RATE (one of 16)
  too_short,  // too_short to wrong_trailer are refusals of decode_request
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

/// Returns the word for the outcome in --json output, such as "wrong_version".
std::string_view name_of(NtpOutcome outcome);

/// Number of datagrams for each outcome.
using NtpCounts = CountsBy<NtpOutcome, ntp_outcomes>;

/// A received datagram, with everything on which the decision depends. `to` and `to_port` are the
/// address and port of the server.
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

/// Requests change no state except the rate limit, which has a fixed size.
class NtpResponder {
 public:
  /// `key`: secret, random in each run. `exempt`: networks whose requests are not limited.
  NtpResponder(const SipHashKey& key, std::vector<AddressBlock> exempt)
      : key_(key), exempt_(std::move(exempt)) {}

  /// Fills `answer` if the outcome is answered or kissed. `now` becomes the transmit stamp, so send
  /// the answer at once. `host_now` is the same moment on the host's time axis; the rate limit uses
  /// it.
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
