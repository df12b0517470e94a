// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/node_frame.h"

#include "kinalign/wire/node_layout.h"

namespace kinalign {

namespace {

constexpr std::size_t clock_size = 8 + 4 + 4 + 8;  // n_tx and the echo

// The largest frame must have the size max_node_datagram.
static_assert(node_datagram_size(clock_size + max_node_samples * max_sample_size, true) ==
              max_node_datagram);

NodeRefusal take_samples(ByteReader& reader, NodeFrame& frame) {
  for (std::size_t i = 0; i < frame.sample_count; ++i) {
    if (!take_sample(reader, frame.samples[i])) return NodeRefusal::reserved_bits;
  }
  return NodeRefusal::none;
}

/// Reads the fields of a frame. If the frame has no echo, the fields of the echo must be zero.
NodeRefusal take_frame(const NodeHead& head, ByteReader& reader, NodeFrame& frame) {
  if (head.byte21 > max_node_samples) return NodeRefusal::too_many_samples;
  frame.origin = head.origin;
  frame.sample_count = head.byte21;
  frame.has_battery = (head.flags & battery_flag) != 0;
  frame.battery_mv = head.battery_mv;
  frame.n_tx_us = reader.take<std::uint64_t>();
  frame.has_echo = (head.flags & echo_flag) != 0;
  frame.echo = {reader.take<std::uint32_t>(), reader.take<std::uint32_t>(),
                reader.take<std::uint64_t>()};
  // A sender that forgets the echo flag would otherwise lose its echoes without notice.
  if (!frame.has_echo && frame.echo != ReplyEcho{}) return NodeRefusal::reserved_bits;
  return take_samples(reader, frame);
}

}  // namespace

std::span<const std::uint8_t> encode(const NodeFrame& frame, const MacKey* key,
                                     std::span<std::uint8_t> out) {
  // The loops below must not read beyond the array.
  if (frame.sample_count > max_node_samples) return {};
  const auto samples = std::span(frame.samples).first(frame.sample_count);
  std::size_t fields = clock_size;
  for (const NodeSample& sample : samples) fields += encoded_size(sample);
  const auto flags = static_cast<std::uint8_t>((frame.has_battery ? battery_flag : 0) |
                                               (frame.has_echo ? echo_flag : 0));
  const std::uint16_t battery = frame.has_battery ? frame.battery_mv : std::uint16_t{0};
  const ReplyEcho echo = frame.has_echo ? frame.echo : ReplyEcho{};
  return encode_as({DatagramType::frame, frame.origin, flags,
                    static_cast<std::uint8_t>(frame.sample_count), battery},
                   fields, key, out, [&](ByteWriter& writer) {
                     writer.put(frame.n_tx_us);
                     writer.put(echo.reply_sequence);
                     writer.put(echo.nonce);
                     writer.put(echo.n_rx_us);
                     for (const NodeSample& sample : samples) put_sample(writer, sample);
                   });
}

NodeRefusal decode(const Envelope& envelope, const MacKey* key, NodeFrame& frame) {
  return decode_as(DatagramType::frame, envelope, key, frame, take_frame);
}

}  // namespace kinalign
