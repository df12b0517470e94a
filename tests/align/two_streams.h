// SPDX-License-Identifier: Apache-2.0
// Optical points and a Kinect of the same four joints: the recording of most tests of alignment.
#pragma once

#include "tests/align/streams.h"

#include "kinalign/motion/arrays.h"
#include "kinalign/take/take.h"

#include <string>
#include <utility>
#include <vector>

namespace kinalign::test {

inline const std::vector<std::string> joints{"SpineBase", "Head", "HandLeft", "HandRight"};

/// A recording of both; the first is the reference.
inline Recording two(PointStream optical, PointStream kinect) {
  Recording recording;
  recording.streams.push_back(recorded("optical", std::move(optical)));
  recording.streams.push_back(recorded("kinect", std::move(kinect)));
  return recording;
}

inline const PointRows& rows(const Take& take, std::size_t group) {
  return std::get<PointRows>(take.all.rows[group]);
}

inline Vec3 at(const PointRows& rows, std::size_t row, std::size_t joint) {
  return vec3(std::span<const double>(rows.positions), row * joints.size() + joint);
}

}  // namespace kinalign::test
