// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/noitom_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::size_t noitom_joints = 59, hierarchy_joint = 10;
// The same limit as in formats/bvh/rows.cpp. A larger value is not a coordinate or an angle.
constexpr double largest = 1e15;
constexpr std::string_view both =
    "the stream does not say which of Noitom's two 59-joint hierarchies it follows, legacy (Axis "
    "Neuron: joint 10 is Spine3) or Studio (Axis Studio: joint 10 is Neck)";

/// The words for a hierarchy in a finding.
std::string_view word(NoitomHierarchy hierarchy) {
  if (hierarchy == NoitomHierarchy::legacy) return "the legacy one";
  return hierarchy == NoitomHierarchy::studio ? "the Studio one" : "neither";
}

bool is_sound(float x) { return std::abs(x) < largest; }

}  // namespace

bool has_sound_values(std::span<const float> row) {
  return std::all_of(row.begin(), row.end(), is_sound);
}

NoitomHierarchy noitom_hierarchy(const BvhHierarchy& hierarchy) {
  if (hierarchy.names.size() != noitom_joints) return NoitomHierarchy::other;
  if (hierarchy.names[hierarchy_joint] == "Spine3") return NoitomHierarchy::legacy;
  return hierarchy.names[hierarchy_joint] == "Neck" ? NoitomHierarchy::studio
                                                    : NoitomHierarchy::other;
}

NoitomPoser::NoitomPoser(BvhHierarchy hierarchy, const BvhOptions& options, std::string name)
    // poser_ keeps a reference to hierarchy_, so hierarchy_ is a member and is initialised first.
    : hierarchy_(std::move(hierarchy)), poser_(hierarchy_, options), name_(std::move(name)) {}

Result<void> NoitomPoser::append(const NoitomFrame& frame, Time stamp, ClipFrames& out) {
  const auto row = frame.row();
  if (row.size() != hierarchy_.row_size()) {
    return Failure(Error{name_, 0,
                         fmt::format("a header with the {} channels of the frames that arrive; {}",
                                     row.size(), both),
                         fmt::format("{} joints with {} channels, {}", hierarchy_.names.size(),
                                     hierarchy_.row_size(), word(noitom_hierarchy(hierarchy_)))});
  }
  if (const auto odd = std::find_if_not(row.begin(), row.end(), is_sound); odd != row.end()) {
    return Failure(
        Error{name_, 0, "numbers in a frame",
              fmt::format("{} as value {} of {}", *odd, odd - row.begin() + 1, row.size())});
  }
  row_.assign(row.begin(), row.end());
  poser_.append(row_, out);
  // The poser computes stamps from the BVH's frame time. A recorded frame has its own stamp
  // instead.
  out.stamps.back() = stamp;
  return {};
}

Findings NoitomPoser::findings() const {
  if (noitom_hierarchy(hierarchy_) != NoitomHierarchy::other) return {};
  return {{Severity::warning,
           Error{name_, 0, "the header of Axis Neuron or Axis Studio",
                 fmt::format("{} joints in another order", hierarchy_.names.size())},
           fmt::format("values may be assigned to the wrong joints: {}", both),
           "give a BVH that the same program has exported of the same person"}};
}

}  // namespace kinalign
