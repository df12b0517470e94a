// SPDX-License-Identifier: Apache-2.0
// The binary encoding of a Kinect's messages: docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/protocols/kinect/message.h"

#include <span>

namespace kinalign {

// Positions and types of the fields: docs/formats/kinect_stream.md, "Binary: head and end".
inline constexpr std::size_t kinect_head_size = 24, kinect_crc_size = 4;
inline constexpr std::size_t most_kinect_bytes = 4498;  // 6 bodies with orientations
inline constexpr std::array<std::uint8_t, 4> kinect_magic{'K', 'A', 'N', 'K'};

/// The length that a message states. `head`: at least its first 8 bytes, which begin with the
/// magic.
std::size_t stated_kinect_length(std::span<const std::uint8_t> head);

/// Checks the first 24 bytes of a message, which begin with the magic: the version, and a length
/// that fits type, flags and counts.
KinectRefusal check_kinect_head(std::span<const std::uint8_t> head);

/// Decodes exactly one message. After a refusal `message` is empty.
KinectRefusal decode_kinect_binary(std::span<const std::uint8_t> bytes, KinectMessage& message);

/// Encodes a message that `check` accepts.
std::vector<std::uint8_t> encode_kinect_binary(const KinectMessage& message);

/// Bytes of a message with a frame of `bodies` bodies.
/// 48 bytes are the frame's own fields. A body has 12 bytes, and each joint 1 state, 12 bytes of
/// position and 16 of orientation.
constexpr std::size_t kinect_frame_size(std::size_t bodies, bool orientations) {
  return kinect_head_size + 48 + kinect_crc_size +
         bodies * (12 + std::size_t{25} * (1 + 12 + (orientations ? 16 : 0)));
}

}  // namespace kinalign
