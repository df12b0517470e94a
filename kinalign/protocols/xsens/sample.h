// SPDX-License-Identifier: Apache-2.0
// What Xsens MVN streams over the network, in its own axes and units: z up, quaternions w,x,y,z.
// Layout: docs/formats/xsens_mvn_stream.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/wire/time.h"

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace kinalign {

/// A segment, a prop or a finger of a character.
struct XsensSegment {
  std::int32_t id = 0;              // 1 Pelvis to 23 LeftToe; further ones are props and fingers
  std::array<float, 3> position{};  // metres or centimetres: XsensPoser decides
  std::array<float, 4> rotation{};  // world_from_segment

  bool operator==(const XsensSegment&) const = default;
};

struct XsensPose {  // type 02
  std::vector<XsensSegment> segments;

  bool operator==(const XsensPose&) const = default;
};

/// What the sensor itself measured, in its own space.
struct XsensRaw {
  std::array<float, 3> acceleration{};      // m/s2, gravity is in
  std::array<float, 3> angular_velocity{};  // rad/s

  bool operator==(const XsensRaw&) const = default;
};

struct XsensTracker {
  std::int32_t id = 0;                       // of the segment it is fixed to
  std::array<float, 4> rotation{};           // world_from_sensor
  std::array<float, 3> free_acceleration{};  // m/s2 in the world, without gravity
  std::optional<XsensRaw> raw;               // in items of 68 bytes
  std::array<float, 3> magnetic_field{};     // of any unit

  bool operator==(const XsensTracker&) const = default;
};

struct XsensTrackers {  // type 23
  std::vector<XsensTracker> trackers;

  bool operator==(const XsensTrackers&) const = default;
};

struct XsensTimeCode {     // type 25
  Duration time_of_day{};  // since midnight, of whole milliseconds

  bool operator==(const XsensTimeCode&) const = default;
};

using XsensItems = std::variant<XsensPose, XsensTrackers, XsensTimeCode>;

struct XsensSample {
  std::uint32_t counter = 0;       // of samples
  std::uint32_t time_code_ms = 0;  // since the recording began
  std::uint8_t character = 0;
  std::uint8_t body_segments = 0;  // 23; 0 before MVN 2019
  std::uint8_t props = 0;
  std::uint8_t finger_segments = 0;
  XsensItems body;

  bool operator==(const XsensSample&) const = default;
};

struct XsensSending {
  std::size_t items_per_datagram = 255;
  bool payload_size = true;     // false: 0, as programs before 2019 send it
  bool long_time_code = false;  // with its length in front, as later programs send it
};

/// The datagrams of a sample; one behind another they are what TCP carries. Fails where it could
/// not be read again: no items or more than 256, trackers with and without raw values, a time of
/// day that is none, raw trackers without their payload size.
Result<std::vector<std::vector<std::uint8_t>>> xsens_datagrams(const XsensSample& sample,
                                                               const XsensSending& sending);

}  // namespace kinalign
