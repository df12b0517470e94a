// SPDX-License-Identifier: Apache-2.0
// The answer of an NTP server, computed from the request, two stamps and the state of the clock.
// This code uses no socket and no clock; the caller passes the time.
#pragma once

#include "kinalign/wire/ntp_packet.h"

#include <cstdint>
#include <optional>

namespace kinalign {

/// The state of the served clock, as answers contain it (RFC 5905 section 7.3).
/// The state is read a few times a second and used for all answers until the next reading. `read`
/// is the time of that reading; an answer adds the error that has grown since.
struct NtpServerState {
  NtpLeap leap = NtpLeap::unsynchronised;
  std::uint8_t stratum = ntp_stratum_unsynchronised;
  std::int8_t precision = -20;  // log2 s
  std::uint32_t reference_id = 0;
  Duration root_delay{0};
  Duration root_dispersion{0};  // value at `read`; grows by 15 ppm after that (RFC 5905: PHI)
  Time reference{};             // the time when the clock was last set or confirmed
  Time read{};                  // the time when this state was read
};

/// Returns the transmit stamp of an answer that is sent `now`. It is never earlier than `received`.
/// Absent if the two differ by more than a second: the clock was then stepped, and an answer would
/// be wrong for the time before or after the step.
std::optional<Time> transmit_stamp(Time received, Time now);

/// Returns the answer to `request`, in the same protocol version. The request's transmit stamp is
/// copied to `originate`.
NtpPacket ntp_answer(const NtpPacket& request, Time received, Time transmit,
                     const NtpServerState& state);

/// Returns a packet with the kiss code RATE (RFC 5905 section 7.4), which tells the client to ask
/// less often. Its stamps are correct, since some clients use them although it is a kiss.
NtpPacket ntp_kiss_rate(const NtpPacket& request, Time received, Time transmit,
                        const NtpServerState& state);

}  // namespace kinalign
