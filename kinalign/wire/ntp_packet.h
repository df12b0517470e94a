// SPDX-License-Identifier: Apache-2.0
// The NTP packet (RFC 5905 section 7.3): 48 bytes in network order. Requests of clients are read by
// decode_request, answers to requests of ours by decode_answer; each says why it refuses.
#pragma once

#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

constexpr std::size_t ntp_packet_size = 48;

/// Seconds since 1900-01-01 UTC and 2^-32 of them, modulo 2^32 s: the eras begin in 1900, 2036 and
/// 2172. 0 means unknown.
struct NtpStamp {
  std::uint64_t bits = 0;
  bool operator==(const NtpStamp&) const = default;
};

/// A delay or a dispersion, 2^-16 s.
struct NtpShort {
  std::uint32_t bits = 0;
  bool operator==(const NtpShort&) const = default;
};

/// The stamp nearest to `t`, never 0: where that would stand, the lowest bit is set.
NtpStamp ntp_from_time(Time t);

/// The time nearest to `pivot` that has this stamp, so any pivot within 68 years of it gives the
/// right era. None: the stamp is 0, or the time is beyond what Time holds.
std::optional<Time> time_from_ntp(NtpStamp stamp, Time pivot);

/// later - earlier for stamps less than 68 years apart, whatever era each is in.
Duration ntp_difference(NtpStamp earlier, NtpStamp later);

/// Rounded up, so that an error stated is never less than the one meant; 0 to 65536 s.
NtpShort ntp_short_from(Duration d);
Duration duration_from(NtpShort value);

enum class NtpLeap : std::uint8_t { none, insert, remove, unsynchronised };

constexpr std::uint8_t ntp_mode_client = 3, ntp_mode_server = 4;
constexpr std::uint8_t ntp_stratum_unsynchronised = 16;

struct NtpPacket {
  NtpLeap leap = NtpLeap::none;
  std::uint8_t version = 4;  // 3 bits
  std::uint8_t mode = 0;     // 3 bits
  std::uint8_t stratum = 0;  // 0 in an answer: a kiss code stands in reference_id
  std::int8_t poll = 0;      // log2 s
  std::int8_t precision = 0;
  NtpShort root_delay, root_dispersion;
  std::uint32_t reference_id = 0;
  NtpStamp reference;  // when the clock was last set
  NtpStamp originate;  // T1: the request's transmit stamp, verbatim
  NtpStamp receive;    // T2
  NtpStamp transmit;   // T3
  bool operator==(const NtpPacket&) const = default;
};

/// Why a datagram is no request to answer; each is counted by its name.
enum class [[nodiscard]] NtpRefusal : std::uint8_t{
    none,
    too_short,      // less than 48 bytes
    wrong_version,  // 0 or above 4
    wrong_mode,     // not from a client; 6 and 7 are those that amplify
    wrong_trailer   // longer than 48 bytes, and what follows is no extension field or MAC
};

/// Fills `packet` where the answer is `none`. Of the fields, a server may believe version, poll and
/// transmit; the rest of a request means nothing (chrony sends zeros there).
NtpRefusal decode_request(std::span<const std::uint8_t> datagram, NtpPacket& packet);

/// Why a datagram is no answer to a request of ours, or which kiss it is (RFC 5905 section 7.4).
enum class [[nodiscard]] NtpAnswer : std::uint8_t{
    good,
    malformed,       // too short, another version or mode than a server's to us
    not_ours,        // originate is not what we sent: a spoof, a duplicate or too late; ignore it
    unsynchronised,  // leap 3, stratum above 15, or no transmit stamp
    kiss_deny,       // DENY or RSTR: stop asking
    kiss_rate,       // RATE: ask half as often, at most
    kiss_other};

/// Fills `packet` where the answer is not `malformed`. `sent`: the transmit stamp of our request.
NtpAnswer decode_answer(std::span<const std::uint8_t> datagram, NtpStamp sent, NtpPacket& packet);

std::array<std::uint8_t, ntp_packet_size> encode(const NtpPacket& packet);

/// Four letters as a reference id or kiss code: ntp_code("RATE").
constexpr std::uint32_t ntp_code(const char (&text)[5]) {
  std::uint32_t code = 0;
  for (int i = 0; i < 4; ++i) code = code << 8 | static_cast<std::uint8_t>(text[i]);
  return code;
}

}  // namespace kinalign
