// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/message.h"

#include <algorithm>

namespace kinalign {

namespace {

using Refusal = KinectRefusal;

// Ticks beyond the limit are not exact in JSON, so neither encoding accepts them.
bool within(std::int64_t value) {
  return value >= -most_kinect_ticks && value <= most_kinect_ticks;
}

bool is_printable(const std::string& text) {
  return text.size() <= 64 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

// The values must be within the ranges of the SDK: four bits for clipped edges, hand states 0 to 4,
// and tracking states 0 to 2.
Refusal check_body(const KinectFrame& frame, const KinectBody& body) {
  const bool no_hands = body.hand_left == 0 && body.hand_right == 0 && body.hand_confidence == 0;
  if (body.clipped_edges > 15 || body.hand_left > 4 || body.hand_right > 4 ||
      body.hand_confidence > 3 || (!frame.has_hands && !no_hands)) {
    return Refusal::reserved_bits;
  }
  const bool known = std::all_of(body.states.begin(), body.states.end(),
                                 [](std::uint8_t state) { return state <= 2; });
  return known ? Refusal::none : Refusal::reserved_bits;
}

/// Checks the fields of each type.
struct Check {
  Refusal operator()(const KinectHello& hello) const {
    return is_printable(hello.serial) && is_printable(hello.sdk) ? Refusal::none
                                                                 : Refusal::wrong_fields;
  }
  /// Checks all numbers against their limits. A frame without bodies must have no hands and no
  /// orientations.
  Refusal operator()(const KinectFrame& frame) const {
    // `more_parts` announces at least one further part.
    const std::size_t parts = frame.part + (frame.more_parts ? 2U : 1U);
    if (frame.bodies.size() > most_kinect_bodies || parts > most_kinect_parts ||
        !within(frame.device_ticks) || !within(frame.taken_ticks) || !within(frame.sent_ticks) ||
        !within(frame.utc_us.value_or(0))) {
      return Refusal::wrong_fields;
    }
    if (frame.bodies.empty() && (frame.has_hands || frame.has_orientations)) {
      return Refusal::reserved_bits;
    }
    for (const KinectBody& body : frame.bodies) {
      if (const auto refusal = check_body(frame, body); refusal != Refusal::none) return refusal;
    }
    return Refusal::none;
  }
  Refusal operator()(const KinectPing& ping) const {
    const bool good = within(ping.sent_ticks) && (!ping.echo || within(ping.echo->received_ticks));
    return good ? Refusal::none : Refusal::wrong_fields;
  }
  Refusal operator()(const KinectPong&) const { return Refusal::none; }
};

}  // namespace

KinectRefusal check(const KinectMessage& message) { return std::visit(Check{}, message); }

const char* name_of(KinectRefusal refusal) {
  static constexpr std::array<const char*, kinect_refusals> names{
      "none",         "too_short",   "no_message",   "too_long",          "unknown_version",
      "wrong_length", "bad_crc",     "unknown_type", "unknown_joint_set", "stray_bits",
      "bad_json",     "wrong_fields"};
  return names[static_cast<std::size_t>(refusal)];
}

}  // namespace kinalign
