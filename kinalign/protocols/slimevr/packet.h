// SPDX-License-Identifier: Apache-2.0
// Decodes datagrams of SlimeVR's trackers and encodes the answers to them: docs/formats/slimevr.md.
// Values are in the tracker's units and axes. slime_orientation() and slime_acceleration() convert
// them to kinalign's units and axes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace kinalign {

using SlimeMac = std::array<std::uint8_t, 6>;

/// The first datagram of a tracker. Fields that older firmware does not send are empty.
struct SlimeHandshake {
  std::optional<std::int32_t> protocol;
  std::optional<SlimeMac> mac;  // also empty if the tracker sends only zeros
};

/// The motion of one sensor: rotation, acceleration, or both. Packet types 1, 16, 17, 4 and 23.
struct SlimeMotion {
  std::uint8_t sensor = 0;
  bool is_correction = false;
  std::optional<std::array<float, 4>> rotation;      // x,y,z,w
  std::optional<std::array<float, 3>> acceleration;  // m/s2
};

/// The state of one sensor. The host acknowledges it by sending the same status.
struct SlimeSensorInfo {
  std::uint8_t sensor = 0, status = 0;
};

/// The state of the tracker's battery. Some trackers send only the level.
struct SlimeBattery {
  std::optional<float> volts;
};

/// A list of the features of the tracker's firmware. The host answers with its own list.
struct SlimeFeatures {};

/// A packet that kinalign does not use, such as a heartbeat or a returned ping. Its body is not
/// read.
struct SlimeOther {};

using SlimePacket = std::variant<SlimeOther, SlimeHandshake, SlimeMotion, SlimeSensorInfo,
                                 SlimeBattery, SlimeFeatures>;

/// A decoded datagram. A packet is left out if its type is unknown or if it is too short for its
/// type. The other packets of the bundle remain valid.
struct SlimeDatagram {
  std::uint32_t type = 0;
  std::uint64_t number = 0;
  std::vector<SlimePacket> packets;  // at most one packet, or all packets of a bundle
};

/// Decodes a datagram. Returns false if it is shorter than its head of 12 bytes.
[[nodiscard]] bool decode_slime(std::span<const std::uint8_t> datagram, SlimeDatagram& out);

/// The unit rotation w,x,y,z from sensor space to a world with y up. The result is empty if
/// `rotation` is not finite or nearly 0.
std::optional<std::array<double, 4>> slime_orientation(const std::array<float, 4>& rotation);

/// The acceleration in sensor space without gravity, m/s2. `protocol`: the version in the
/// handshake; 0 if the handshake has none.
std::optional<std::array<double, 3>> slime_acceleration(const std::array<float, 3>& acceleration,
                                                        std::int32_t protocol);

/// A datagram to a tracker.
struct SlimeAnswer {
  std::array<std::uint8_t, 64> bytes{};
  std::size_t size = 0;

  std::span<const std::uint8_t> datagram() const { return std::span(bytes).first(size); }
};

/// The firmware compares this many bytes of the answer and ignores a shorter answer.
inline constexpr std::size_t least_slime_handshake_answer = 13;

/// The answer to a handshake. It is as long as the handshake, but at least 13 and at most 64 bytes.
SlimeAnswer slime_handshake_answer(std::size_t handshake_size);
/// A datagram that the host sends without a request. A tracker drops the connection if it receives
/// nothing for three seconds.
SlimeAnswer slime_heartbeat();
/// A ping. The tracker returns it with the same id.
SlimeAnswer slime_ping(std::uint32_t id);
/// The answer to a sensor info. It repeats the status that the tracker sent.
SlimeAnswer slime_sensor_info_acknowledged(std::uint8_t sensor, std::uint8_t status);
/// Informs the tracker that the host understands bundles and compact bundles.
SlimeAnswer slime_features();

}  // namespace kinalign
