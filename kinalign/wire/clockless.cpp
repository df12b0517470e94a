// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/clockless.h"

#include "kinalign/wire/node_layout.h"

namespace kinalign {

namespace {

// Size of nonce, T2 and T3. A request contains as many zero bytes, so that the answer is not longer
// than the request.
constexpr std::size_t times_size = 4 + 8 + 8;

/// Reads the fields of a request. The bytes reserved for the answer's times must be zero.
NodeRefusal take_request(const NodeHead& head, ByteReader& reader, ClocklessRequest& request) {
  if (head.byte21 > 1) return NodeRefusal::too_many_samples;
  request.origin = head.origin;
  request.has_battery = (head.flags & battery_flag) != 0;
  request.battery_mv = head.battery_mv;
  request.has_sample = head.byte21 != 0;
  // In version 1 these bytes must be 0, so that a later version can give them a meaning.
  for (std::size_t i = 0; i < times_size; ++i) {
    if (reader.take<std::uint8_t>() != 0) return NodeRefusal::reserved_bits;
  }
  if (request.has_sample && !take_sample(reader, request.sample)) return NodeRefusal::reserved_bits;
  return NodeRefusal::none;
}

/// Reads the fields of an answer or of a confirm. Both datagrams have the same fields.
template <class Stamped>
NodeRefusal take_times(const NodeHead& head, ByteReader& reader, Stamped& stamped) {
  if (head.byte21 != 0) return NodeRefusal::reserved_bits;
  stamped.origin = head.origin;
  stamped.times = {reader.take<std::uint32_t>(), reader.take<std::uint64_t>(),
                   reader.take<std::uint64_t>()};
  return NodeRefusal::none;
}

}  // namespace

std::span<const std::uint8_t> encode(const ClocklessRequest& request, const MacKey* key,
                                     std::span<std::uint8_t> out) {
  // If there is no battery, the battery field of the datagram is zero, whatever `request` contains.
  const std::uint8_t flags = request.has_battery ? battery_flag : 0;
  const std::uint8_t count = request.has_sample ? 1 : 0;
  const std::uint16_t battery = request.has_battery ? request.battery_mv : std::uint16_t{0};
  const std::size_t sample = request.has_sample ? encoded_size(request.sample) : 0;
  return encode_as({DatagramType::request, request.origin, flags, count, battery},
                   times_size + sample, key, out, [&](ByteWriter& writer) {
                     for (std::size_t i = 0; i < times_size; ++i) writer.put(std::uint8_t{0});
                     if (request.has_sample) put_sample(writer, request.sample);
                   });
}

template <DatagramType type>
std::span<const std::uint8_t> encode(const ClocklessStamped<type>& stamped, const MacKey* key,
                                     std::span<std::uint8_t> out) {
  return encode_as({type, stamped.origin, 0, 0, 0}, times_size, key, out, [&](ByteWriter& writer) {
    writer.put(stamped.times.nonce);
    writer.put(stamped.times.t2_ns);
    writer.put(stamped.times.t3_ns);
  });
}

NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessRequest& request) {
  return decode_as(DatagramType::request, envelope, key, request, take_request);
}

template <DatagramType type>
NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessStamped<type>& stamped) {
  return decode_as(type, envelope, key, stamped, take_times<ClocklessStamped<type>>);
}

template std::span<const std::uint8_t> encode(const ClocklessAnswer&, const MacKey*,
                                              std::span<std::uint8_t>);
template std::span<const std::uint8_t> encode(const ClocklessConfirm&, const MacKey*,
                                              std::span<std::uint8_t>);
template NodeRefusal decode(const Envelope&, const MacKey*, ClocklessAnswer&);
template NodeRefusal decode(const Envelope&, const MacKey*, ClocklessConfirm&);

}  // namespace kinalign
