// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/joint_frames.h"

#include "kinalign/motion/index_of.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

namespace {

/// The joint's name on the other side of the body; `name` itself if it contains no side.
/// Words are tried before first letters. A joint such as "root" gives "loot"; no skeleton has such
/// a joint, so mirror_partners() makes "root" its own partner.
std::string other_side(const std::string& name) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 4> words{
      {{"Left", "Right"}, {"Right", "Left"}, {"left", "right"}, {"right", "left"}}};
  for (const auto& [here, there] : words) {
    const std::size_t at = name.find(here);
    if (at == std::string::npos) continue;
    return name.substr(0, at) + std::string(there) + name.substr(at + here.size());
  }
  if (name.empty()) return name;
  static constexpr std::array<std::pair<char, char>, 4> letters{
      {{'L', 'R'}, {'R', 'L'}, {'l', 'r'}, {'r', 'l'}}};
  for (const auto& [here, there] : letters) {
    if (name.front() == here) return there + name.substr(1);
  }
  return name;
}

}  // namespace

std::vector<std::size_t> mirror_partners(const std::vector<std::string>& names) {
  std::vector<std::size_t> out(names.size());
  for (std::size_t j = 0; j < names.size(); ++j) {
    out[j] = index_of(names, other_side(names[j])).value_or(j);
  }
  return out;
}

void mirror_positions(std::span<float> positions, const std::vector<std::size_t>& partners) {
  const std::size_t joints = partners.size();
  for (std::size_t at = 0; at + 3 * joints <= positions.size() && joints > 0; at += 3 * joints) {
    float* row = &positions[at];
    for (std::size_t j = 0; j < joints; ++j) {
      // Each pair is exchanged once, at the lower index.
      if (partners[j] > j) std::swap_ranges(row + 3 * j, row + 3 * j + 3, row + 3 * partners[j]);
    }
    for (std::size_t j = 0; j < joints; ++j) row[3 * j] = -row[3 * j];
  }
}

void mirror(JointFrames& body, const std::vector<std::size_t>& partners) {
  mirror_positions(body.positions, partners);
  for (std::size_t t = 0; t < body.frames(); ++t) {
    std::uint8_t* seen = &body.seen[t * body.joints];
    for (std::size_t j = 0; j < body.joints; ++j) {
      if (partners[j] > j) std::swap(seen[j], seen[partners[j]]);
    }
  }
}

}  // namespace kinalign
