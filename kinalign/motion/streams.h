// SPDX-License-Identifier: Apache-2.0
// Streams of points (Kinect joints, optical markers) and of inertial nodes. Metres, m/s2, rad/s,
// right-handed, y up; rotations w,x,y,z; arrays row-major.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The state that a device reports for a joint; the numbers are the Kinect SDK's TrackingState.
enum class Tracking : std::uint8_t { missing = 0, inferred = 1, tracked = 2 };

/// T frames of J points. A missing point holds zeros.
struct PointFrames {
  std::vector<Time> stamps;       // [T] as given by the device; may repeat and step back
  std::vector<double> positions;  // [T,J,3] m
  std::vector<Tracking> state;    // [T,J] of each point in each frame

  std::size_t size() const { return stamps.size(); }
};

struct PointStream {
  std::vector<std::string> joint_names;  // [J]
  PointFrames frames;
};

/// The quantities of a stream of inertial nodes; absent ones have empty arrays.
struct ImuContent {
  bool orientation = false;
  bool acceleration = false;
  bool angular_velocity = false;
  bool gravity = true;  // the acceleration contains gravity: a node at rest reads +9.8 upwards

  bool operator==(const ImuContent&) const = default;
};

/// T samples of S nodes with common stamps. A sample that is not valid holds zeros.
struct ImuSamples {
  std::vector<Time> stamps;              // [T] as given by the device
  std::vector<double> orientation;       // [T,S,4] world_from_sensor, unit; world is y up
  std::vector<double> acceleration;      // [T,S,3] m/s2, in the sensor's space
  std::vector<double> angular_velocity;  // [T,S,3] rad/s, in the sensor's space
  std::vector<std::uint8_t> valid;       // [T,S] 1: all present quantities were read

  std::size_t size() const { return stamps.size(); }
};

struct ImuStream {
  std::vector<std::string> node_names;  // [S]
  ImuContent content;
  ImuSamples samples;
};

}  // namespace kinalign
