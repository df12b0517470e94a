// SPDX-License-Identifier: Apache-2.0
// The binary encoding of the messages from a Kinect's sender: docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/protocols/kinect/message.h"

#include <span>

namespace kinalign {

// Positions and types of the fields: docs/formats/kinect_stream.md, "Binary: head and end".
inline constexpr std::size_t kinect_head_size = 24, kinect_crc_size = 4;
inline constexpr std::size_t most_kinect_bytes = 4498;  // 6 bodies with joint orientations
inline constexpr std::array<std::uint8_t, 4> kinect_magic{'K', 'A', 'N', 'K'};

/// The length that a message states, bytes. `head`: at least its first 8 bytes, from the magic on.
std::size_t stated_kinect_length(std::span<const std::uint8_t> head);

/// Checks the first 24 bytes of a message, from the magic on. The version must be known, and the
/// length must fit type, flags and counts.
KinectRefusal check_kinect_head(std::span<const std::uint8_t> head);

/// Decodes exactly one message. If it is refused, `message` is empty.
KinectRefusal decode_kinect_binary(std::span<const std::uint8_t> bytes, KinectMessage& message);

/// Encodes a message. The message must have passed check() of message.h.
std::vector<std::uint8_t> encode_kinect_binary(const KinectMessage& message);

/// The bytes of a message with a frame of `bodies` bodies. The frame's own fields have 48 bytes,
/// and a body has 12. Each joint has 1 byte for its state, 12 for its position and 16 for its
/// orientation.
constexpr std::size_t kinect_frame_size(std::size_t bodies, bool orientations) {
  return kinect_head_size + 48 + kinect_crc_size +
         bodies * (12 + std::size_t{25} * (1 + 12 + (orientations ? 16 : 0)));
}

}  // namespace kinalign
