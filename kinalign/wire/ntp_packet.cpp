// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/ntp_packet.h"

#include "kinalign/wire/bytes.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::int64_t ns_per_s = 1'000'000'000;
constexpr std::int64_t from_1900_to_1970_s = 2'208'988'800;

/// True if the `left` bytes after the extension fields can be a MAC. In version 4 a MAC is a key id
/// alone (a crypto-NAK), or a key id with a digest of 16 or 20 bytes (RFC 7822 section 7.5). Before
/// version 4 it may also have a digest of 8 bytes (RFC 1305), but is never a key id alone.
bool is_mac(std::size_t left, std::uint8_t version) {
  return left == 20 || left == 24 || left == (version == 4 ? 4U : 12U);
}

/// Checks the bytes after the header: extension fields, then a MAC or nothing. Only version 4 has
/// extension fields. Each one contains its type and its length, and has at least 16 bytes. If no
/// MAC follows, the last field has at least 28 bytes.
bool is_trailer(std::span<const std::uint8_t> rest, std::uint8_t version) {
  constexpr std::size_t least_field = 16, least_last_field = 28;
  while (version == 4 && rest.size() >= least_last_field) {
    ByteReader field(rest);
    field.take<std::uint16_t>();  // the type: fields of all types are skipped
    // The field's length includes the four bytes of type and length.
    const std::size_t length = field.take<std::uint16_t>();
    if (length < least_field || length % 4 != 0 || length > rest.size()) return false;
    if (length == rest.size()) return length >= least_last_field;
    rest = rest.subspan(length);
  }
  return rest.empty() || is_mac(rest.size(), version);
}

}  // namespace

NtpStamp ntp_from_time(Time t) {
  // Before 1970 the remainder is negative, so one second is borrowed.
  const std::int64_t rest = to_ns(t) % ns_per_s;
  const std::int64_t s = to_ns(t) / ns_per_s - (rest < 0 ? 1 : 0);
  const std::int64_t ns = rest < 0 ? rest + ns_per_s : rest;
  // NTP seconds have 32 bits. The shift below drops the higher bits, which count the eras.
  const auto seconds_1900 = static_cast<std::uint64_t>(s + from_1900_to_1970_s);
  // The fraction is rounded to the nearest. For 999,999,999 ns it is still below 2^32.
  const std::uint64_t fraction = ((static_cast<std::uint64_t>(ns) << 32) + ns_per_s / 2) / ns_per_s;
  const std::uint64_t bits = seconds_1900 << 32 | fraction;
  return {bits == 0 ? 1 : bits};
}

NtpShort ntp_short_from(Duration d) {
  const std::int64_t ns = std::clamp(d, Duration{0}, Duration{65536 * ns_per_s}).count();
  const std::uint64_t bits = ((static_cast<std::uint64_t>(ns) << 16) + ns_per_s - 1) / ns_per_s;
  return {static_cast<std::uint32_t>(std::min<std::uint64_t>(bits, UINT32_MAX))};
}

NtpPacket ntp_header(std::span<const std::uint8_t> datagram) {
  ByteReader reader(datagram);
  NtpPacket packet;
  const auto first = reader.take<std::uint8_t>();
  // The bits from the top: leap indicator (2), version (3), mode (3).
  packet.leap = static_cast<NtpLeap>(first >> 6);
  packet.version = first >> 3 & 7;
  packet.mode = first & 7;
  packet.stratum = reader.take<std::uint8_t>();
  packet.poll = static_cast<std::int8_t>(reader.take<std::uint8_t>());
  packet.precision = static_cast<std::int8_t>(reader.take<std::uint8_t>());
  packet.root_delay = {reader.take<std::uint32_t>()};
  packet.root_dispersion = {reader.take<std::uint32_t>()};
  packet.reference_id = reader.take<std::uint32_t>();
  packet.reference = {reader.take<std::uint64_t>()};
  packet.originate = {reader.take<std::uint64_t>()};
  packet.receive = {reader.take<std::uint64_t>()};
  packet.transmit = {reader.take<std::uint64_t>()};
  return packet;
}

NtpRefusal decode_request(std::span<const std::uint8_t> datagram, NtpPacket& packet) {
  if (datagram.size() < ntp_packet_size) return NtpRefusal::too_short;
  const NtpPacket read = ntp_header(datagram);
  if (read.version < 1 || read.version > 4) return NtpRefusal::wrong_version;
  if (read.mode != ntp_mode_client) return NtpRefusal::wrong_mode;
  if (!is_trailer(datagram.subspan(ntp_packet_size), read.version))
    return NtpRefusal::wrong_trailer;
  // A refused datagram leaves `packet` unchanged.
  packet = read;
  return NtpRefusal::none;
}

std::array<std::uint8_t, ntp_packet_size> encode(const NtpPacket& packet) {
  std::array<std::uint8_t, ntp_packet_size> bytes{};
  ByteWriter writer(bytes);
  const auto leap = static_cast<unsigned>(packet.leap);
  writer.put(
      static_cast<std::uint8_t>(leap << 6 | (packet.version & 7U) << 3 | (packet.mode & 7U)));
  writer.put(packet.stratum);
  writer.put(static_cast<std::uint8_t>(packet.poll));
  writer.put(static_cast<std::uint8_t>(packet.precision));
  writer.put(packet.root_delay.bits);
  writer.put(packet.root_dispersion.bits);
  writer.put(packet.reference_id);
  writer.put(packet.reference.bits);
  writer.put(packet.originate.bits);
  writer.put(packet.receive.bits);
  writer.put(packet.transmit.bits);
  return bytes;
}

}  // namespace kinalign
