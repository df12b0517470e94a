// SPDX-License-Identifier: Apache-2.0
// An NTP server's answer, computed from the request, two stamps and the state of the clock. It uses
// no socket and no clock; time is an argument.
#pragma once

#include "kinalign/wire/ntp_packet.h"

#include <cstdint>
#include <optional>

namespace kinalign {

/// The state of the served clock, as answers contain it (RFC 5905 section 7.3).
/// It is read a few times a second and used for all answers until then; `read` lets an answer add
/// the error that has grown since.
struct NtpServerState {
  NtpLeap leap = NtpLeap::unsynchronised;
  std::uint8_t stratum = ntp_stratum_unsynchronised;
  std::int8_t precision = -20;  // log2 s
  std::uint32_t reference_id = 0;
  Duration root_delay{0};
  Duration root_dispersion{0};  // at `read`; grows by 15 ppm after that (RFC 5905: PHI)
  Time reference{};             // the time when the clock was last set or confirmed
  Time read{};                  // the time when this state was read
};

/// The transmit stamp of an answer that is sent `now`: never before `received`. Absent if they
/// differ by more than a second. The clock was then stepped in between, and an answer would be
/// wrong about either clock.
std::optional<Time> transmit_stamp(Time received, Time now);

/// The answer to `request`, in the same version. The request's transmit stamp is copied to
/// `originate`.
NtpPacket ntp_answer(const NtpPacket& request, Time received, Time transmit,
                     const NtpServerState& state);

/// The kiss code RATE (RFC 5905 section 7.4) tells the client to ask less often. Its stamps are
/// correct, since some clients use them before they notice the kiss.
NtpPacket ntp_kiss_rate(const NtpPacket& request, Time received, Time transmit,
                        const NtpServerState& state);

}  // namespace kinalign
