// SPDX-License-Identifier: Apache-2.0
// The encoding of a Kinect's messages as JSON, one object per line: docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/protocols/kinect/message.h"

#include <string_view>

namespace kinalign {

/// Limits in bytes, including the line end. A ping has a minimum length, so that no pong is longer
/// than its ping. Pongs therefore can't be used for amplification.
inline constexpr std::size_t most_kinect_line = 65'536, least_kinect_ping_line = 160;

/// Decodes one line, with or without its line end. If it is refused, `message` is empty.
KinectRefusal decode_kinect_line(std::string_view line, KinectMessage& message);

/// Encodes a pong as a line with its line end. The host sends no other message.
std::string encode_kinect_line(const KinectPong& pong);

}  // namespace kinalign
