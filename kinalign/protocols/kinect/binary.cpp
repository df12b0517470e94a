// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/binary.h"

#include "kinalign/wire/crc32.h"
#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>
#include <cassert>

namespace kinalign {

namespace {

using Refusal = KinectRefusal;

// The numbers in a message's head: docs/formats/kinect_stream.md. A bit that version 1 does not use
// must be 0, so that a later version can give it a meaning.
constexpr std::uint8_t version = 1, kinect_v2 = 1;
constexpr std::uint8_t hello_type = 1, frame_type = 2, ping_type = 3, pong_type = 4;
constexpr std::uint8_t utc_flag = 1, floor_flag = 2, orientations_flag = 4, hands_flag = 8,
                       more_parts_flag = 16, echo_flag = 1;

/// The fields of a message's head that differ from message to message.
struct Head {
  std::uint8_t type = 0;
  KinectOrigin origin;
  std::uint8_t flags = 0, joint_set = 0, bodies = 0, part = 0;
};

// ---- Functions for reading.

// Magic, version and length were checked by the caller, so they are skipped here.
Head take_head(LittleEndianReader& reader) {
  Head head;
  reader.take_bytes(kinect_magic.size() + 1);  // the magic and the version
  head.type = reader.take<std::uint8_t>();
  reader.take<std::uint16_t>();
  head.origin.sensor = reader.take<std::uint32_t>();
  head.origin.session = reader.take<std::uint32_t>();
  head.origin.sequence = reader.take<std::uint32_t>();
  head.flags = reader.take<std::uint8_t>();
  head.joint_set = reader.take<std::uint8_t>();
  head.bodies = reader.take<std::uint8_t>();
  head.part = reader.take<std::uint8_t>();
  return head;
}

// Reads a text: its length in one byte, then its characters without a zero at the end.
std::string take_short_text(LittleEndianReader& reader) {
  const auto bytes = reader.take_bytes(reader.take<std::uint8_t>());
  return {bytes.begin(), bytes.end()};
}

/// Each take_ function decodes the fields of one type of message. It refuses flags and fields that
/// the type does not use.
Refusal take_hello(const Head& head, LittleEndianReader& reader, KinectMessage& message) {
  if (head.flags != 0 || head.bodies != 0 || head.part != 0) return Refusal::reserved_bits;
  KinectHello hello{head.origin, {}, {}};
  hello.serial = take_short_text(reader);
  hello.sdk = take_short_text(reader);
  message = std::move(hello);
  return Refusal::none;
}

KinectBody take_body(LittleEndianReader& reader, bool has_orientations) {
  KinectBody body;
  body.id = reader.take<std::uint64_t>();
  body.clipped_edges = reader.take<std::uint8_t>();
  body.hand_left = reader.take<std::uint8_t>();
  body.hand_right = reader.take<std::uint8_t>();
  body.hand_confidence = reader.take<std::uint8_t>();
  for (std::uint8_t& state : body.states) state = reader.take<std::uint8_t>();
  body.positions = reader.take_floats<std::tuple_size_v<decltype(body.positions)>>();
  if (has_orientations) {
    body.orientations = reader.take_floats<std::tuple_size_v<decltype(body.orientations)>>();
  }
  return body;
}

/// Decodes a frame. If a flag says that a field is absent, the field must be zero.
Refusal take_frame(const Head& head, LittleEndianReader& reader, KinectMessage& message) {
  if (head.flags > 31) return Refusal::reserved_bits;
  if (head.bodies > most_kinect_bodies) return Refusal::wrong_fields;
  KinectFrame frame;
  frame.origin = head.origin;
  frame.part = head.part;
  frame.more_parts = (head.flags & more_parts_flag) != 0;
  frame.has_orientations = (head.flags & orientations_flag) != 0;
  frame.has_hands = (head.flags & hands_flag) != 0;
  frame.device_ticks = reader.take<std::int64_t>();
  frame.taken_ticks = reader.take<std::int64_t>();
  frame.sent_ticks = reader.take<std::int64_t>();
  const auto utc_us = reader.take<std::int64_t>();
  const auto floor = reader.take_floats<4>();
  if ((head.flags & utc_flag) != 0) {
    frame.utc_us = utc_us;
  } else if (utc_us != 0) {
    return Refusal::reserved_bits;
  }
  if ((head.flags & floor_flag) != 0) {
    frame.floor = floor;
  } else if (std::any_of(floor.begin(), floor.end(),
                         [](float x) { return std::bit_cast<std::uint32_t>(x) != 0; })) {
    return Refusal::reserved_bits;
  }
  // If the message is too short for its bodies, the loop ends early. The caller then refuses the
  // message because of its length.
  for (std::uint8_t i = 0; i < head.bodies && reader.complete(); ++i) {
    frame.bodies.push_back(take_body(reader, frame.has_orientations));
  }
  message = std::move(frame);
  return Refusal::none;
}

/// Decodes a ping. Without the echo flag, the fields of the echo must be zero.
Refusal take_ping(const Head& head, LittleEndianReader& reader, KinectMessage& message) {
  if (head.flags > echo_flag || head.joint_set != 0 || head.bodies != 0 || head.part != 0) {
    return Refusal::reserved_bits;
  }
  KinectPing ping{head.origin, reader.take<std::int64_t>(), std::nullopt};
  KinectEcho echo;
  echo.pong_sequence = reader.take<std::uint32_t>();
  echo.nonce = reader.take<std::uint32_t>();
  echo.received_ticks = reader.take<std::int64_t>();
  if (head.flags == echo_flag) {
    ping.echo = echo;
  } else if (!(echo == KinectEcho{})) {
    return Refusal::reserved_bits;
  }
  message = ping;
  return Refusal::none;
}

// The host sends pongs and never receives them. Only tests and simulated senders decode them.
Refusal take_pong(const Head& head, LittleEndianReader& reader, KinectMessage& message) {
  if (head.flags != 0 || head.joint_set != 0 || head.bodies != 0 || head.part != 0) {
    return Refusal::reserved_bits;
  }
  KinectPong pong{head.origin, reader.take<std::uint32_t>(), 0};
  pong.nonce = reader.take<std::uint32_t>();
  message = pong;
  return Refusal::none;
}

/// Decodes the fields of a message by its type. Only hellos and frames have a joint set.
Refusal take_fields(const Head& head, LittleEndianReader& reader, KinectMessage& message) {
  const bool has_joints = head.type == hello_type || head.type == frame_type;
  if (has_joints && head.joint_set != kinect_v2) return Refusal::unknown_joint_set;
  switch (head.type) {
    case hello_type:
      return take_hello(head, reader, message);
    case frame_type:
      return take_frame(head, reader, message);
    case ping_type:
      return take_ping(head, reader, message);
    case pong_type:
      return take_pong(head, reader, message);
    default:
      return Refusal::unknown_type;
  }
}

/// Checks length, magic, version and CRC of a message.
Refusal open(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kinect_head_size + kinect_crc_size) return Refusal::too_short;
  if (!std::equal(kinect_magic.begin(), kinect_magic.end(), bytes.begin())) {
    return Refusal::no_message;
  }
  if (bytes[4] != version) return Refusal::unknown_version;
  if (bytes.size() > most_kinect_bytes) return Refusal::too_long;
  if (stated_kinect_length(bytes) != bytes.size()) return Refusal::wrong_length;
  // The CRC is checked last: its position follows from the length.
  LittleEndianReader crc(bytes.last(kinect_crc_size));
  const auto checked = bytes.first(bytes.size() - kinect_crc_size);
  return crc.take<std::uint32_t>() == crc32(checked) ? Refusal::none : Refusal::bad_crc;
}

// ---- Functions for writing.

void put_head(std::vector<std::uint8_t>& out, const Head& head) {
  for (const std::uint8_t byte : kinect_magic) append_little(byte, out);
  append_little(version, out);
  append_little(head.type, out);
  append_little(std::uint16_t{0}, out);  // the length, which is filled in later
  append_little(head.origin.sensor, out);
  append_little(head.origin.session, out);
  append_little(head.origin.sequence, out);
  append_little(head.flags, out);
  append_little(head.joint_set, out);
  append_little(head.bodies, out);
  append_little(head.part, out);
}

template <std::size_t n>
void put_floats(std::vector<std::uint8_t>& out, const std::array<float, n>& from) {
  for (const float number : from) append_little(std::bit_cast<std::uint32_t>(number), out);
}

void put_short_text(std::vector<std::uint8_t>& out, const std::string& text) {
  append_little(static_cast<std::uint8_t>(text.size()), out);
  out.insert(out.end(), text.begin(), text.end());
}

void put_body(std::vector<std::uint8_t>& out, const KinectBody& body, bool has_orientations) {
  append_little(body.id, out);
  append_little(body.clipped_edges, out);
  append_little(body.hand_left, out);
  append_little(body.hand_right, out);
  append_little(body.hand_confidence, out);
  for (const std::uint8_t state : body.states) append_little(state, out);
  put_floats(out, body.positions);
  if (has_orientations) put_floats(out, body.orientations);
}

// The flags say which optional fields have values. Absent fields are written as zeros.
std::uint8_t flags_of(const KinectFrame& frame) {
  return static_cast<std::uint8_t>((frame.utc_us ? utc_flag : 0) | (frame.floor ? floor_flag : 0) |
                                   (frame.has_orientations ? orientations_flag : 0) |
                                   (frame.has_hands ? hands_flag : 0) |
                                   (frame.more_parts ? more_parts_flag : 0));
}

/// Encodes each type of message, without the CRC.
struct Put {
  std::vector<std::uint8_t>& out;

  void operator()(const KinectHello& hello) const {
    put_head(out, {hello_type, hello.origin, 0, kinect_v2, 0, 0});
    put_short_text(out, hello.serial);
    put_short_text(out, hello.sdk);
  }
  void operator()(const KinectFrame& frame) const {
    put_head(out, {frame_type, frame.origin, flags_of(frame), kinect_v2,
                   static_cast<std::uint8_t>(frame.bodies.size()), frame.part});
    append_little(static_cast<std::uint64_t>(frame.device_ticks), out);
    append_little(static_cast<std::uint64_t>(frame.taken_ticks), out);
    append_little(static_cast<std::uint64_t>(frame.sent_ticks), out);
    append_little(static_cast<std::uint64_t>(frame.utc_us.value_or(0)), out);
    put_floats(out, frame.floor.value_or(std::array<float, 4>{}));
    for (const KinectBody& body : frame.bodies) put_body(out, body, frame.has_orientations);
  }
  void operator()(const KinectPing& ping) const {
    const auto flags = static_cast<std::uint8_t>(ping.echo ? echo_flag : 0);
    const KinectEcho echo = ping.echo.value_or(KinectEcho{});
    put_head(out, {ping_type, ping.origin, flags, 0, 0, 0});
    append_little(static_cast<std::uint64_t>(ping.sent_ticks), out);
    append_little(echo.pong_sequence, out);
    append_little(echo.nonce, out);
    append_little(static_cast<std::uint64_t>(echo.received_ticks), out);
  }
  void operator()(const KinectPong& pong) const {
    put_head(out, {pong_type, pong.origin, 0, 0, 0, 0});
    append_little(pong.pong_sequence, out);
    append_little(pong.nonce, out);
  }
};

}  // namespace

std::size_t stated_kinect_length(std::span<const std::uint8_t> head) {
  return head[6] | static_cast<std::size_t>(head[7]) << 8;
}

// On a connection this check runs before the whole message has arrived. An impossible head means
// that the magic was part of other data. The search for the next message then continues at once,
// instead of waiting for up to 4498 bytes.
KinectRefusal check_kinect_head(std::span<const std::uint8_t> head) {
  if (head[4] != version) return Refusal::unknown_version;
  const std::size_t length = stated_kinect_length(head);
  // If the length is too small, the difference wraps to a size that fits no type.
  const std::size_t fields = length - kinect_head_size;
  if (length > most_kinect_bytes) return Refusal::too_long;
  const std::uint8_t type = head[5], bodies = head[22];
  const bool oriented = (head[20] & orientations_flag) != 0;
  // A hello has two texts of at most 64 bytes, each after its length. In all other types, flags and
  // number of bodies determine the size.
  const bool fits = (type == hello_type && fields >= 2 + kinect_crc_size &&
                     fields <= 2 * (1 + 64) + kinect_crc_size) ||
                    (type == frame_type && length == kinect_frame_size(bodies, oriented)) ||
                    (type == ping_type && fields == 24 + kinect_crc_size) ||
                    (type == pong_type && fields == 8 + kinect_crc_size);
  if (type < hello_type || type > pong_type) return Refusal::unknown_type;
  return fits ? Refusal::none : Refusal::wrong_length;
}

KinectRefusal decode_kinect_binary(std::span<const std::uint8_t> bytes, KinectMessage& message) {
  message = {};
  if (const auto refusal = open(bytes); refusal != Refusal::none) return refusal;
  LittleEndianReader reader(bytes.first(bytes.size() - kinect_crc_size));
  const Head head = take_head(reader);
  Refusal refusal = take_fields(head, reader, message);
  // The fields must use exactly all bytes of the message.
  if (refusal == Refusal::none && (!reader.complete() || reader.left() != 0)) {
    refusal = Refusal::wrong_length;
  }
  if (refusal == Refusal::none) refusal = check(message);
  if (refusal != Refusal::none) message = {};
  return refusal;
}

std::vector<std::uint8_t> encode_kinect_binary(const KinectMessage& message) {
  assert(check(message) == Refusal::none);
  std::vector<std::uint8_t> out;
  std::visit(Put{out}, message);
  // The length is written before the CRC is computed, because the CRC covers the length.
  const std::size_t length = out.size() + kinect_crc_size;
  out[6] = static_cast<std::uint8_t>(length & 0xff);
  out[7] = static_cast<std::uint8_t>(length >> 8);
  append_little(crc32(out), out);
  return out;
}

}  // namespace kinalign
