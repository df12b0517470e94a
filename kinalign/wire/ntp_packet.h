// SPDX-License-Identifier: Apache-2.0
// The NTP packet (RFC 5905 section 7.3) as a server needs it: 48 bytes in network order.
#pragma once

#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

constexpr std::size_t ntp_packet_size = 48;

/// A time in units of 2^-32 s since 1900-01-01 UTC, modulo 2^32 s. The eras begin in 1900, 2036 and
/// 2172. The value 0 means unknown.
struct NtpStamp {
  std::uint64_t bits = 0;
  bool operator==(const NtpStamp&) const = default;
};

/// A delay or a dispersion in units of 2^-16 s.
struct NtpShort {
  std::uint32_t bits = 0;
  bool operator==(const NtpShort&) const = default;
};

/// The stamp nearest to `t`. A result of 0 would mean unknown, so its lowest bit is set.
NtpStamp ntp_from_time(Time t);

/// The duration, rounded up so that a stated error is never too small, within 0 to 65536 s.
NtpShort ntp_short_from(Duration d);

enum class NtpLeap : std::uint8_t { none, insert, remove, unsynchronised };

constexpr std::uint8_t ntp_mode_client = 3, ntp_mode_server = 4;
constexpr std::uint8_t ntp_stratum_unsynchronised = 16;

struct NtpPacket {
  NtpLeap leap = NtpLeap::none;
  std::uint8_t version = 4;  // 3 bits
  std::uint8_t mode = 0;     // 3 bits
  std::uint8_t stratum = 0;  // in an answer, 0 means that reference_id contains a kiss code
  std::int8_t poll = 0;      // the logarithm to base 2 of the poll interval in seconds
  // The logarithm to base 2 of the clock's precision in seconds.
  std::int8_t precision = 0;
  NtpShort root_delay, root_dispersion;
  std::uint32_t reference_id = 0;
  NtpStamp reference;  // the time when the clock was last set
  NtpStamp originate;  // T1: a copy of the transmit stamp in the request
  NtpStamp receive;    // T2: arrival of the request
  NtpStamp transmit;   // T3: departure of the answer
  bool operator==(const NtpPacket&) const = default;
};

/// The reason why a server does not answer a datagram. Servers count each reason by its name.
enum class [[nodiscard]] NtpRefusal : std::uint8_t{
    none,
    too_short,      // less than 48 bytes
    wrong_version,  // version 0, or a version above 4
    wrong_mode,     // not from a client; attackers use modes 6 and 7 for amplification
    wrong_trailer   // more than 48 bytes, but neither extension fields nor a MAC
};

/// Reads the 48 bytes of the header, which must exist.
NtpPacket ntp_header(std::span<const std::uint8_t> datagram);

/// Fills `packet` if the result is `none`. A server may use only version, poll and transmit. The
/// other fields of a request have no meaning (chrony sends zeros).
NtpRefusal decode_request(std::span<const std::uint8_t> datagram, NtpPacket& packet);

std::array<std::uint8_t, ntp_packet_size> encode(const NtpPacket& packet);

/// The number of a reference id or kiss code with four letters, as in ntp_code("RATE").
constexpr std::uint32_t ntp_code(const char (&text)[5]) {
  std::uint32_t code = 0;
  for (int i = 0; i < 4; ++i) code = code << 8 | static_cast<std::uint8_t>(text[i]);
  return code;
}

}  // namespace kinalign
