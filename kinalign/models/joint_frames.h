// SPDX-License-Identifier: Apache-2.0
// A skeleton of points on an even grid: the input and the output of methods that clean skeletons.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// T frames of J joints. Metres, y up; arrays row-major. A joint that is not seen holds zeros.
struct JointFrames {
  std::size_t joints = 0;
  std::vector<float> positions;    // [T,J,3] m
  std::vector<std::uint8_t> seen;  // [T,J] 0 missing, 1 inferred, 2 tracked (Tracking)

  std::size_t frames() const { return joints == 0 ? 0 : seen.size() / joints; }
};

/// For each joint the index of its counterpart on the other side of the body: "KneeLeft" and
/// "KneeRight", "LeftKnee" and "RightKnee", "lwrist" and "rwrist". A joint without a counterpart
/// gets its own index.
std::vector<std::size_t> mirror_partners(const std::vector<std::string>& names);

/// Mirrors positions [T,J,3]: negates x, exchanges left and right.
void mirror_positions(std::span<float> positions, const std::vector<std::size_t>& partners);

/// Mirrors a body: negates x, exchanges left and right, and exchanges their states.
void mirror(JointFrames& body, const std::vector<std::size_t>& partners);

}  // namespace kinalign
