// SPDX-License-Identifier: Apache-2.0
// Decides on each datagram of the NTP port: answered, limited, or refused, and for which reason.
// No socket and no clock, so that every rule is tested without either.
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

/// What became of a datagram; each has exactly one.
enum class NtpOutcome : std::uint8_t {
  answered,
  limited,    // the address asks too often: no answer
  kissed,     // and is told so, of 16 times once
  too_short,  // the refusals of decode_request
  wrong_version,
  wrong_mode,
  wrong_trailer,
  from_port_0,    // nobody listens there
  from_itself,    // the server's own address and port: it would talk to itself
  not_unicast,    // asked of a broadcast or multicast address: many would answer
  clock_stepped,  // between its arrival and its answer
  unsent,         // the system did not take the answer
  from_node,      // an inertial node's datagram: it has its own port
};
constexpr std::size_t ntp_outcomes = 13;

/// As in --json: "wrong_version".
std::string_view name_of(NtpOutcome outcome);

/// Of datagrams.
using NtpCounts = CountsBy<NtpOutcome, ntp_outcomes>;

/// A datagram as it arrived.
struct NtpAsked {
  std::span<const std::uint8_t> bytes;
  bool cut = false;  // it was longer
  HostAddress from{};
  std::uint16_t from_port = 0;
  HostAddress to{};
  std::uint16_t to_port = 0;
  bool unicast = true;
  Time received{};
};

class NtpResponder {
 public:
  /// `key`: random in each run, known to nobody. `exempt`: networks that are answered however often
  /// they ask.
  NtpResponder(const SipHashKey& key, std::vector<AddressBlock> exempt)
      : key_(key), exempt_(std::move(exempt)) {}

  /// Fills `answer` where the outcome is answered or kissed. `now`: for the transmit stamp, so the
  /// answer is to be sent at once; `host_now`: the same moment for the limit.
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
