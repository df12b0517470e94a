// SPDX-License-Identifier: Apache-2.0
// What an NTP server answers, from its request, two stamps and the state of the clock served. No
// socket, no clock: time comes in as an argument.
#pragma once

#include "kinalign/wire/ntp_packet.h"

#include <cstdint>
#include <optional>

namespace kinalign {

/// What answers say of the clock that is served (RFC 5905 section 7.3).
struct NtpServerState {
  NtpLeap leap = NtpLeap::unsynchronised;
  std::uint8_t stratum = ntp_stratum_unsynchronised;
  std::int8_t precision = -20;  // log2 s
  std::uint32_t reference_id = 0;
  Duration root_delay{0};
  Duration root_dispersion{0};  // at `read`; grows from there on by 15 ppm (RFC 5905: PHI)
  Time reference{};             // when the clock was last set or found right
  Time read{};                  // when all this was read
};

/// The transmit stamp of an answer that is sent `now`: never before `received`. None where more
/// than a second lies between them: the clock was stepped meanwhile, and what the answer would say
/// of either clock is wrong.
std::optional<Time> transmit_stamp(Time received, Time now);

/// The answer to `request`, of the same version: its transmit stamp, verbatim, is the originate.
NtpPacket ntp_answer(const NtpPacket& request, Time received, Time transmit,
                     const NtpServerState& state);

/// The kiss RATE (RFC 5905 section 7.4): ask less often. Its stamps are true, since some clients
/// look at them before they see the kiss.
NtpPacket ntp_kiss_rate(const NtpPacket& request, Time received, Time transmit,
                        const NtpServerState& state);

}  // namespace kinalign
