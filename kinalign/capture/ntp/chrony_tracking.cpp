// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/chrony_tracking.h"

#include "kinalign/wire/bytes.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::uint8_t protocol = 6, request = 1, answer = 2;
constexpr std::uint16_t tracking_request = 33, tracking_answer = 5, status_success = 0;

/// Reads chrony's floating-point format, seconds: 7 bits of exponent, 25 bits of coefficient, both
/// signed.
Duration take_seconds(ByteReader& reader) {
  const auto bits = reader.take<std::uint32_t>();
  const int exponent = static_cast<std::int32_t>(bits) >> 25;
  const int coefficient = static_cast<std::int32_t>(bits << 7) >> 7;
  const double s = std::ldexp(coefficient, exponent - 25);
  constexpr double most_s = 65'536;  // the range of NTP's short format
  return std::chrono::ceil<Duration>(std::chrono::duration<double>(std::clamp(s, 0.0, most_s)));
}

// Seconds since 1970 as 64 bits, the upper half first. Values beyond the year 2255 are clamped,
// because they would overflow in ns.
Time take_time(ByteReader& reader) {
  const auto high = reader.take<std::uint32_t>();
  const auto low = reader.take<std::uint32_t>();
  const auto ns = reader.take<std::uint32_t>();
  const std::uint64_t s = std::min((std::uint64_t{high} << 32) + low, std::uint64_t{9'000'000'000});
  return Time{std::chrono::seconds(s) + Duration{ns}};
}

}  // namespace

// The request is padded with zeros to the size of its answer.
std::array<std::uint8_t, chrony_tracking_size> chrony_tracking_request(std::uint32_t sequence) {
  std::array<std::uint8_t, chrony_tracking_size> bytes{};
  ByteWriter writer(bytes);
  writer.put(protocol);
  writer.put(request);
  writer.put(std::uint16_t{0});
  writer.put(tracking_request);
  writer.put(std::uint16_t{0});  // attempt
  writer.put(sequence);
  return bytes;
}

std::optional<ChronyTracking> decode_chrony_tracking(std::span<const std::uint8_t> datagram,
                                                     std::uint32_t sequence) {
  ByteReader reader(datagram);
  // Fields in the order of the protocol: version, kind, two reserved bytes, command, reply, status.
  const bool ours = reader.take<std::uint8_t>() == protocol &&
                    reader.take<std::uint8_t>() == answer && reader.take<std::uint16_t>() == 0 &&
                    reader.take<std::uint16_t>() == tracking_request &&
                    reader.take<std::uint16_t>() == tracking_answer &&
                    reader.take<std::uint16_t>() == status_success;
  reader.take_bytes(6);
  if (!ours || reader.take<std::uint32_t>() != sequence) return std::nullopt;
  constexpr std::size_t padding = 8, reference_id_and_address = 24, corrections = 24;
  reader.take_bytes(padding + reference_id_and_address);
  ChronyTracking tracking;
  tracking.stratum = reader.take<std::uint16_t>();
  tracking.leap = static_cast<NtpLeap>(std::min<std::uint16_t>(reader.take<std::uint16_t>(), 3));
  tracking.reference = take_time(reader);
  reader.take_bytes(corrections);
  tracking.root_delay = take_seconds(reader);
  tracking.root_dispersion = take_seconds(reader);
  return reader.complete() ? std::optional(tracking) : std::nullopt;
}

}  // namespace kinalign
