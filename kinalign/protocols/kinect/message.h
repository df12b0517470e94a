// SPDX-License-Identifier: Apache-2.0
// The messages between a Kinect's sender and the host: docs/formats/kinect_stream.md. A Kinect's
// sender is the program that reads the Kinect and sends its frames. Two encodings of the messages
// exist: binary.h and lines.h.
#pragma once

#include "kinalign/motion/kinect_joints.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace kinalign {

inline constexpr std::size_t most_kinect_bodies = 6, most_kinect_parts = 6;
/// The limit of ticks and of UTC, for both signs. Integers up to this limit are exact in a double.
inline constexpr std::int64_t most_kinect_ticks = (std::int64_t{1} << 53) - 1;

/// Identifies a message: the sensor, the run of the sender program, and the number within that run.
struct KinectOrigin {
  std::uint32_t sensor = 0;    // the sensor's number in the lab
  std::uint32_t session = 0;   // a random number that each run of the sender chooses
  std::uint32_t sequence = 0;  // hellos, frames and pings have separate numbers

  bool operator==(const KinectOrigin&) const = default;
};

/// Describes the sensor. A sender sends a hello at its start and then once a second, so that a
/// receiver that starts later gets one, too.
struct KinectHello {
  KinectOrigin origin;
  std::string serial, sdk;  // printable ASCII, at most 64 characters
};

/// One person. The values come from the SDK and are not checked: a joint may be NaN.
struct KinectBody {
  std::uint64_t id = 0;
  std::uint8_t clipped_edges = 0;              // a sum of 1 right, 2 left, 4 top, 8 bottom
  std::uint8_t hand_left = 0, hand_right = 0;  // HandState of the SDK, if the frame has hands
  std::uint8_t hand_confidence = 0;       // 1: high for the left hand; 2: for the right; 3: both
  std::array<std::uint8_t, 25> states{};  // TrackingState of the SDK
  std::array<float, std::size_t{25} * 3> positions{};     // [25,3] m, camera space
  std::array<float, std::size_t{25} * 4> orientations{};  // [25,4] w,x,y,z, if the frame has them
};

/// A frame, or a part of a frame. A tick is 100 ns. The page docs/formats/kinect_stream.md explains
/// the three times under "Three clocks".
struct KinectFrame {
  KinectOrigin origin;
  std::uint8_t part = 0;
  bool more_parts = false;                           // more parts of this frame follow
  std::int64_t device_ticks = 0;                     // time of the frame on the sensor's clock
  std::int64_t taken_ticks = 0;                      // arrival at the sender, on its clock
  std::int64_t sent_ticks = 0;                       // just before sending, on the sender's clock
  std::optional<std::int64_t> utc_us;                // the sender's wall clock at taken_ticks, us
  std::optional<std::array<float, 4>> floor;         // the floor's plane x,y,z,w
  bool has_orientations = false, has_hands = false;  // false if there are no bodies
  std::vector<KinectBody> bodies;                    // at most 6
};

/// The sender's answer to a pong. It travels in the next ping.
struct KinectEcho {
  std::uint32_t pong_sequence = 0, nonce = 0;
  std::int64_t received_ticks = 0;

  bool operator==(const KinectEcho&) const = default;
};

/// A request for a time exchange. The ping also echoes the newest pong, so that the host knows all
/// four times of that exchange.
struct KinectPing {
  KinectOrigin origin;
  std::int64_t sent_ticks = 0;
  std::optional<KinectEcho> echo;
};

/// The host's answer to a ping. The nonce is random, so only a sender that received the pong can
/// echo it.
struct KinectPong {
  KinectOrigin origin;  // the origin of the ping
  std::uint32_t pong_sequence = 0, nonce = 0;
};

using KinectMessage = std::variant<KinectHello, KinectFrame, KinectPing, KinectPong>;

/// Reasons to refuse a message. The recorder counts each reason under its name.
enum class [[nodiscard]] KinectRefusal : std::uint8_t{
    none,    too_short,    no_message,        too_long,      unknown_version, wrong_length,
    bad_crc, unknown_type, unknown_joint_set, reserved_bits, bad_json,        wrong_fields};
inline constexpr std::size_t kinect_refusals = 12;

/// The refusal's name in the output of --json, for example "bad_crc".
const char* name_of(KinectRefusal refusal);

/// Checks that both encodings can express the message. The decoders of both encodings call it.
KinectRefusal check(const KinectMessage& message);

}  // namespace kinalign
