// SPDX-License-Identifier: Apache-2.0
// The messages between a Kinect's sender and the host: docs/formats/kinect_stream.md. Their two
// encodings are binary.h and lines.h.
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
/// Limit of ticks and of UTC, of either sign: integers up to it are exact in a double.
inline constexpr std::int64_t most_kinect_ticks = (std::int64_t{1} << 53) - 1;

/// Identifies a message: the sensor, the run of its sender, and the number within that run.
struct KinectOrigin {
  std::uint32_t sensor = 0;    // number of the sensor in the lab
  std::uint32_t session = 0;   // random number of a run of the sender
  std::uint32_t sequence = 0;  // hellos, frames and pings are numbered separately

  bool operator==(const KinectOrigin&) const = default;
};

/// Sent when the sender begins and once a second, so a receiver that starts later learns the sensor
/// too.
struct KinectHello {
  KinectOrigin origin;
  std::string serial, sdk;  // printable ASCII, 64 at most
};

/// One person. The values are the SDK's own and are not checked: a joint may be NaN.
struct KinectBody {
  std::uint64_t id = 0;
  std::uint8_t clipped_edges = 0;              // 1 right, 2 left, 4 top, 8 bottom
  std::uint8_t hand_left = 0, hand_right = 0;  // HandState, if the frame has hands
  std::uint8_t hand_confidence = 0;  // 1: the left hand's confidence is high; 2: the right hand's
  std::array<std::uint8_t, 25> states{};                  // TrackingState
  std::array<float, std::size_t{25} * 3> positions{};     // [25,3] m, camera space
  std::array<float, std::size_t{25} * 4> orientations{};  // [25,4] w,x,y,z, if the frame has them
};

/// A frame, or a part of it. Ticks are 100 ns.
/// The three times are explained in docs/formats/kinect_stream.md, "Three clocks".
struct KinectFrame {
  KinectOrigin origin;
  std::uint8_t part = 0;
  bool more_parts = false;                    // more parts of this frame follow
  std::int64_t device_ticks = 0;              // on the sensor's clock
  std::int64_t taken_ticks = 0;               // on the sender's clock, when it received the frame
  std::int64_t sent_ticks = 0;                // on the sender's clock, just before sending
  std::optional<std::int64_t> utc_us;         // the sender's wall clock at taken_ticks, us
  std::optional<std::array<float, 4>> floor;  // clip plane x,y,z,w
  bool has_orientations = false, has_hands = false;  // only if there are bodies
  std::vector<KinectBody> bodies;                    // at most 6
};

/// Answer to a pong, within the next ping.
struct KinectEcho {
  std::uint32_t pong_sequence = 0, nonce = 0;
  std::int64_t received_ticks = 0;

  bool operator==(const KinectEcho&) const = default;
};

/// A request for a time exchange. It also echoes the newest pong, so that the host gets all four
/// times of an exchange.
struct KinectPing {
  KinectOrigin origin;
  std::int64_t sent_ticks = 0;
  std::optional<KinectEcho> echo;
};

/// The host's answer. The nonce is random: only a sender that received the pong can echo it.
struct KinectPong {
  KinectOrigin origin;  // the ping's
  std::uint32_t pong_sequence = 0, nonce = 0;
};

using KinectMessage = std::variant<KinectHello, KinectFrame, KinectPing, KinectPong>;

/// Reasons to refuse a message; each is counted under its name.
enum class [[nodiscard]] KinectRefusal : std::uint8_t{
    none,    too_short,    no_message,        too_long,      unknown_version, wrong_length,
    bad_crc, unknown_type, unknown_joint_set, reserved_bits, bad_json,        wrong_fields};
inline constexpr std::size_t kinect_refusals = 12;

/// The refusal's name in --json: "bad_crc".
const char* name_of(KinectRefusal refusal);

/// Checks that both encodings can express the message. Both decoders call it.
KinectRefusal check(const KinectMessage& message);

}  // namespace kinalign
