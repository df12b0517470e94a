// SPDX-License-Identifier: Apache-2.0
// A skeleton of points on an even grid: what methods clean, and what they answer with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// T frames of J joints. Metres, y up; array row-major. A joint that is not seen holds zeros.
struct JointFrames {
  std::size_t joints = 0;
  std::vector<float> positions;    // [T,J,3] m
  std::vector<std::uint8_t> seen;  // [T,J] 0 missing, 1 inferred, 2 tracked (Tracking)

  std::size_t frames() const { return joints == 0 ? 0 : seen.size() / joints; }
};

/// For each joint the one on the other side of the body: "KneeLeft" and "KneeRight", "LeftKnee" and
/// "RightKnee", "lwrist" and "rwrist"; itself where there is none.
std::vector<std::size_t> mirror_partners(const std::vector<std::string>& names);

/// Positions [T,J,3] as a mirror shows them: x negated, left and right exchanged.
void mirror_positions(std::span<float> positions, const std::vector<std::size_t>& partners);

/// The body as a mirror shows it: x negated, left and right exchanged.
void mirror(JointFrames& body, const std::vector<std::size_t>& partners);

}  // namespace kinalign
