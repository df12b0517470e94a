// SPDX-License-Identifier: Apache-2.0
// The client's side of NTP, for tests: reads an answer and computes with its stamps.
#pragma once

#include "kinalign/wire/counter.h"
#include "kinalign/wire/ntp_packet.h"

#include <optional>

namespace kinalign {

/// The answer of a server to the request with the transmit stamp `sent`. Absent if the bytes are
/// none.
inline std::optional<NtpPacket> ntp_answer_in(std::span<const std::uint8_t> bytes, NtpStamp sent) {
  if (bytes.size() < ntp_packet_size) return std::nullopt;
  const NtpPacket read = ntp_header(bytes);
  const bool fits = read.version >= 1 && read.version <= 4 && read.mode == ntp_mode_server;
  return fits && read.originate == sent ? std::optional(read) : std::nullopt;
}

/// Nanoseconds of a fraction of 2^-32 s, rounded to the nearest; at most 1e9.
inline std::int64_t ntp_ns(std::uint32_t fraction) {
  const std::uint64_t scaled = std::uint64_t{fraction} * 1'000'000'000 + (std::uint64_t{1} << 31);
  return static_cast<std::int64_t>(scaled >> 32);
}

/// The time with this stamp that is nearest to `pivot`; within 68 years the era is right.
inline Time time_from_ntp(NtpStamp stamp, Time pivot) {
  constexpr std::int64_t s = 1'000'000'000, from_1900_to_1970_s = 2'208'988'800;
  const std::int64_t pivot_s = to_ns(pivot) / s + from_1900_to_1970_s;
  const std::int64_t since_1900_s = unwrapped(stamp.bits >> 32, 32, pivot_s);
  return utc_time((since_1900_s - from_1900_to_1970_s) * s +
                  ntp_ns(static_cast<std::uint32_t>(stamp.bits)));
}

/// later - earlier, for stamps less than 68 years apart. The stamps may be in different eras.
inline Duration ntp_difference(NtpStamp earlier, NtpStamp later) {
  const std::uint64_t apart = later.bits - earlier.bits;
  const std::int64_t whole_s = static_cast<std::int32_t>(apart >> 32);
  return Duration{whole_s * 1'000'000'000 + ntp_ns(static_cast<std::uint32_t>(apart))};
}

}  // namespace kinalign
