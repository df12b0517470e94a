// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/clockless.h"

#include "kinalign/wire/node_layout.h"

namespace kinalign {

namespace {

// nonce, T2, T3. A request has as many zero bytes, so that the answer is not longer.
constexpr std::size_t times_size = 4 + 8 + 8;

/// Reads the fields of a request. The room for the answer's times must be zero.
NodeRefusal take_request(const NodeHead& head, ByteReader& reader, ClocklessRequest& request) {
  if (head.byte21 > 1) return NodeRefusal::too_many_samples;
  request.origin = head.origin;
  request.has_battery = (head.flags & battery_flag) != 0;
  request.battery_mv = head.battery_mv;
  request.has_sample = head.byte21 != 0;
  // Version 1 keeps these bytes at 0, so a later version can give them a meaning.
  for (std::size_t i = 0; i < times_size; ++i) {
    if (reader.take<std::uint8_t>() != 0) return NodeRefusal::stray_bits;
  }
  if (request.has_sample && !take_sample(reader, request.sample)) return NodeRefusal::stray_bits;
  return NodeRefusal::none;
}

/// Answer and confirm differ only in the type.
template <class Exchange>
NodeRefusal take_times(const NodeHead& head, ByteReader& reader, Exchange& exchange) {
  if (head.byte21 != 0) return NodeRefusal::stray_bits;
  exchange.origin = head.origin;
  exchange.times = {reader.take<std::uint32_t>(), reader.take<std::uint64_t>(),
                    reader.take<std::uint64_t>()};
  return NodeRefusal::none;
}

template <class Exchange>
std::span<const std::uint8_t> encode_times(DatagramType type, const Exchange& exchange,
                                           const MacKey* key, std::span<std::uint8_t> out) {
  const std::size_t size = encoded_size(exchange, key);
  if (size > out.size()) return {};
  ByteWriter writer = begin_datagram(out, size, {type, exchange.origin, 0, 0, 0}, key);
  writer.put(exchange.times.nonce);
  writer.put(exchange.times.t2_ns);
  writer.put(exchange.times.t3_ns);
  return seal(out.first(size), key);
}

}  // namespace

std::size_t encoded_size(const ClocklessRequest& request, const MacKey* key) {
  const std::size_t sample = request.has_sample ? encoded_size(request.sample) : 0;
  return node_datagram_size(times_size + sample, key != nullptr);
}

std::size_t encoded_size(const ClocklessAnswer&, const MacKey* key) {
  return node_datagram_size(times_size, key != nullptr);
}

std::size_t encoded_size(const ClocklessConfirm&, const MacKey* key) {
  return node_datagram_size(times_size, key != nullptr);
}

std::span<const std::uint8_t> encode(const ClocklessRequest& request, const MacKey* key,
                                     std::span<std::uint8_t> out) {
  const std::size_t size = encoded_size(request, key);
  if (size > out.size()) return {};
  // Without a battery the field is zero on the wire, whatever the structure contains.
  const std::uint8_t flags = request.has_battery ? battery_flag : 0;
  const std::uint8_t count = request.has_sample ? 1 : 0;
  const std::uint16_t battery = request.has_battery ? request.battery_mv : std::uint16_t{0};
  ByteWriter writer = begin_datagram(
      out, size, {DatagramType::request, request.origin, flags, count, battery}, key);
  for (std::size_t i = 0; i < times_size; ++i) writer.put(std::uint8_t{0});
  if (request.has_sample) put_sample(writer, request.sample);
  return seal(out.first(size), key);
}

std::span<const std::uint8_t> encode(const ClocklessAnswer& answer, const MacKey* key,
                                     std::span<std::uint8_t> out) {
  return encode_times(DatagramType::answer, answer, key, out);
}

std::span<const std::uint8_t> encode(const ClocklessConfirm& confirm, const MacKey* key,
                                     std::span<std::uint8_t> out) {
  return encode_times(DatagramType::confirm, confirm, key, out);
}

NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessRequest& request) {
  return decode_as(DatagramType::request, envelope, key, request, take_request);
}

NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessAnswer& answer) {
  return decode_as(DatagramType::answer, envelope, key, answer, take_times<ClocklessAnswer>);
}

NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessConfirm& confirm) {
  return decode_as(DatagramType::confirm, envelope, key, confirm, take_times<ClocklessConfirm>);
}

}  // namespace kinalign
