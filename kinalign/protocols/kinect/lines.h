// SPDX-License-Identifier: Apache-2.0
// The encoding of a Kinect's messages as JSON, one object a line: docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/protocols/kinect/message.h"

#include <string_view>

namespace kinalign {

/// Limits in bytes. The least length of a ping includes the line end. It ensures that no pong is
/// longer than its ping, so pongs can't be used for amplification.
inline constexpr std::size_t most_kinect_line = 65'536, least_kinect_ping_line = 160;

/// Decodes one line, with or without its line end. After a refusal `message` is empty.
KinectRefusal decode_kinect_line(std::string_view line, KinectMessage& message);

/// Encodes a pong, with its line end. The host sends no other message.
std::string encode_kinect_line(const KinectPong& pong);

}  // namespace kinalign
