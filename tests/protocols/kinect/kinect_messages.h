// SPDX-License-Identifier: Apache-2.0
// Messages of a Kinect's sender for tests.
#pragma once

#include "tests/protocols/kinect/kinect_lines.h"

#include "kinalign/protocols/kinect/binary.h"

#include <bit>
#include <random>

namespace kinalign {

inline std::int64_t any_ticks(std::mt19937_64& random) {
  const std::int64_t ticks = static_cast<std::int64_t>(random() >> 11);  // below 2^53
  return random() % 2 == 0 ? ticks : -ticks;
}

/// A float of random bits that are not NaN.
inline float any_finite(std::mt19937_64& random) {
  for (;;) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (value - value == 0.0F) return value;
  }
}

inline KinectBody any_body(std::mt19937_64& random, bool hands, bool orientations) {
  KinectBody body;
  body.id = random();
  body.clipped_edges = static_cast<std::uint8_t>(random() % 16);
  if (hands) {
    body.hand_left = static_cast<std::uint8_t>(random() % 5);
    body.hand_right = static_cast<std::uint8_t>(random() % 5);
    body.hand_confidence = static_cast<std::uint8_t>(random() % 4);
  }
  for (auto& state : body.states) state = static_cast<std::uint8_t>(random() % 3);
  for (auto& x : body.positions) x = any_finite(random);
  for (auto& x : body.orientations) x = orientations ? any_finite(random) : 0.0F;
  return body;
}

inline KinectFrame any_frame(std::mt19937_64& random) {
  KinectFrame frame;
  frame.origin = {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random()),
                  static_cast<std::uint32_t>(random())};
  frame.part = static_cast<std::uint8_t>(random() % 5);
  frame.more_parts = random() % 2 == 0;
  frame.device_ticks = any_ticks(random);
  frame.taken_ticks = any_ticks(random);
  frame.sent_ticks = any_ticks(random);
  if (random() % 2 == 0) frame.utc_us = any_ticks(random);
  if (random() % 2 == 0) {
    for (float& x : frame.floor.emplace()) x = any_finite(random);
  }
  const std::size_t bodies = random() % 7;
  frame.has_hands = bodies > 0 && random() % 2 == 0;
  frame.has_orientations = bodies > 0 && random() % 2 == 0;
  for (std::size_t i = 0; i < bodies; ++i) {
    frame.bodies.push_back(any_body(random, frame.has_hands, frame.has_orientations));
  }
  return frame;
}

inline KinectMessage any_message(std::mt19937_64& random) {
  const KinectFrame frame = any_frame(random);
  const auto nonce = static_cast<std::uint32_t>(random());
  switch (random() % 6) {
    case 0:
      return KinectHello{frame.origin, std::string(random() % 65, '\\'), "2.0 \"1410\""};
    case 1:
      return KinectPing{frame.origin, frame.sent_ticks, std::nullopt};
    case 2:
      return KinectPing{frame.origin, frame.sent_ticks, KinectEcho{nonce, 7, -5}};
    case 3:
      return KinectPong{frame.origin, nonce, frame.origin.session};
    default:
      return frame;
  }
}

/// A frame of one sensor's first session.
inline KinectFrame frame_of(std::uint32_t sequence, std::vector<std::uint64_t> ids) {
  KinectFrame frame;
  frame.origin = {2, 77, sequence};
  frame.device_ticks = 1000 + std::int64_t{333'333} * sequence;
  for (const std::uint64_t id : ids) {
    KinectBody& body = frame.bodies.emplace_back();
    body.id = id;
    body.states.fill(2);
    body.positions.fill(static_cast<float>(id));
  }
  return frame;
}

/// Most bytes of a datagram that fit into an Ethernet frame, over IPv6 and IPv4.
inline constexpr std::size_t most_kinect_datagram = 1452;

// Each part repeats the frame's own fields, so the receiver can use the parts that arrive if one is
// lost. A frame without bodies is one part.
/// Splits a frame so that no message is longer than most_kinect_datagram.
inline std::vector<KinectFrame> kinect_parts(const KinectFrame& frame) {
  std::size_t most = 1;  // bodies of a part
  while (kinect_frame_size(most + 1, frame.has_orientations) <= most_kinect_datagram) ++most;
  std::vector<KinectFrame> parts;
  std::size_t at = 0;
  do {
    const std::size_t end = std::min(at + most, frame.bodies.size());
    KinectFrame part = frame;
    part.bodies.assign(frame.bodies.begin() + static_cast<std::ptrdiff_t>(at),
                       frame.bodies.begin() + static_cast<std::ptrdiff_t>(end));
    part.part = static_cast<std::uint8_t>(parts.size());
    part.more_parts = end < frame.bodies.size();
    parts.push_back(std::move(part));
    at = end;
  } while (at < frame.bodies.size());
  return parts;
}

}  // namespace kinalign
