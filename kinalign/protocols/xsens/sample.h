// SPDX-License-Identifier: Apache-2.0
// The content of Xsens MVN's network stream in MVN's own axes and units: z up, quaternions w,x,y,z.
// Layout: docs/formats/xsens_mvn_stream.md.
#pragma once

#include "kinalign/wire/time.h"

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace kinalign {

/// A segment, a prop or a finger of a character. The values are as sent, with z up.
/// `recording/streams` converts them to y up.
struct XsensSegment {
  std::int32_t id = 0;              // 1 Pelvis to 23 LeftToe; higher numbers are props and fingers
  std::array<float, 3> position{};  // m or cm; XsensPoser finds out which
  std::array<float, 4> rotation{};  // world_from_segment

  bool operator==(const XsensSegment&) const = default;
};

struct XsensPose {  // the content of type 02
  std::vector<XsensSegment> segments;

  bool operator==(const XsensPose&) const = default;
};

/// Raw measurements of a sensor, in its own space.
struct XsensRaw {
  std::array<float, 3> acceleration{};      // m/s2, gravity included
  std::array<float, 3> angular_velocity{};  // rad/s

  bool operator==(const XsensRaw&) const = default;
};

/// An inertial sensor on a segment. It has fused values, and raw values if the sender includes
/// them.
struct XsensTracker {
  std::int32_t id = 0;                       // number of the segment that carries the sensor
  std::array<float, 4> rotation{};           // world_from_sensor
  std::array<float, 3> free_acceleration{};  // m/s2 in the world, without gravity
  std::optional<XsensRaw> raw;               // only in the long items of 68 bytes
  std::array<float, 3> magnetic_field{};     // in the sender's unit

  bool operator==(const XsensTracker&) const = default;
};

struct XsensTrackers {  // the content of type 23
  std::vector<XsensTracker> trackers;

  bool operator==(const XsensTrackers&) const = default;
};

/// The sender's time of day, without a date.
struct XsensTimeCode {     // the content of type 25
  Duration time_of_day{};  // since midnight, in whole milliseconds

  bool operator==(const XsensTimeCode&) const = default;
};

using XsensItems = std::variant<XsensPose, XsensTrackers, XsensTimeCode>;

/// All items of one type at one instant. Several datagrams may contribute to a sample.
struct XsensSample {
  std::uint32_t counter = 0;       // number of the sample
  std::uint32_t time_code_ms = 0;  // ms since the start of the recording
  std::uint8_t character = 0;
  std::uint8_t body_segments = 0;  // segments of the body: 23; MVN before 2019: 0
  std::uint8_t props = 0;
  std::uint8_t finger_segments = 0;
  XsensItems body;

  bool operator==(const XsensSample&) const = default;
};

}  // namespace kinalign
