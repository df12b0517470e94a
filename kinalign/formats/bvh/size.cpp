// SPDX-License-Identifier: Apache-2.0
// Checks the assumed unit and up axis. A BVH file states neither, so the check assumes that the
// skeleton is a standing person.
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/motion/kinematics.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <vector>

namespace kinalign {

namespace {

/// The bounding box of the rest pose (all rotations zero) in the file's axes, m. The first root is
/// at the origin.
Eigen::AlignedBox3d rest_box(const Skeleton& skeleton) {
  std::vector<Vec3> at(skeleton.joints(), Vec3::Zero());
  Eigen::AlignedBox3d box(Vec3::Zero());
  for (std::size_t j = 0; j < skeleton.joints(); ++j) {
    const int parent = skeleton.parents[j];
    // Roots are at the origin, because their position in the world does not matter.
    if (parent >= 0) at[j] = at[static_cast<std::size_t>(parent)] + skeleton.rest_offsets[j];
    box.extend(at[j]);
  }
  for (const EndSite& site : skeleton.end_sites) {
    box.extend(at[static_cast<std::size_t>(site.parent)] + site.offset);
  }
  return box;
}

struct Unit {
  double metres;
  std::string_view name;
};

// Units in public files (docs/formats/bvh.md). The last one is the unit of the CMU database.
constexpr std::array<Unit, 5> units{{{0.01, "centimetres"},
                                     {1.0, "metres"},
                                     {0.001, "millimetres"},
                                     {0.0254, "inches"},
                                     {0.056444, "CMU units of 5.64 cm"}}};

/// The unit for which the height of the hips is nearest to 0.9 m. This is 0.53 of a stature of 1.7
/// m (Drillis and Contini, 1964).
const Unit& best_unit(double hip_in_units) {
  const Unit* best = units.data();
  // If two units are equally near, the first one is used.
  for (const Unit& unit : units) {
    const auto off = [hip_in_units](const Unit& u) {
      return std::abs(hip_in_units * u.metres - 0.9);
    };
    if (off(unit) < off(*best)) best = &unit;
  }
  return *best;
}

// The components of a vector that may point up.
constexpr int y = 1, z = 2;

/// True if the person stands in the first row, false if the person lies, empty if neither is clear.
/// The up axis is y. A standing person is narrow along z, even with spread arms. A lying person is
/// low along y.
std::optional<bool> stands(const BvhHierarchy& hierarchy, const Skeleton& skeleton,
                           std::span<const double> rows, const BvhOptions& options) {
  if (rows.empty()) return std::nullopt;
  ClipFrames frame;
  BvhPoser(hierarchy, options).append(rows.first(hierarchy.row_size()), frame);
  std::vector<double> positions(skeleton.joints() * 3);
  forward_kinematics(skeleton, frame, positions);
  Eigen::AlignedBox3d box;
  for (std::size_t j = 0; j < skeleton.joints(); ++j) box.extend(Vec3(vec3(positions, j)));
  const Vec3 size = box.sizes();
  // The factor 0.5 leaves a margin, so that an unclear pose gives no result.
  if (size.y() < 0.5 * size.z()) return false;
  if (size.z() < 0.5 * size.y()) return true;
  return std::nullopt;
}

Finding lying(std::string_view name, const std::string& expected, const std::string& found,
              char other) {
  return {Severity::warning, Error{std::string(name), 0, expected, found},
          "the person appears to lie",
          fmt::format("set --up {0} (up = \"{0}\" in a manifest) if the person stood", other)};
}

}  // namespace

Findings judge_size(const BvhHierarchy& hierarchy, const Skeleton& skeleton,
                    std::span<const double> rows, const BvhOptions& options,
                    std::string_view name) {
  constexpr std::size_t body = 10;  // with fewer joints it is not a whole person
  Findings findings;
  if (skeleton.joints() < body) return findings;
  const Eigen::AlignedBox3d rest = rest_box(skeleton);
  int up = options.z_up ? z : y;
  const int other = options.z_up ? y : z;
  const bool rest_lies = rest.sizes()[up] < 0.5 * rest.sizes()[other];
  const auto standing = stands(hierarchy, skeleton, rows, options);
  const std::string_view axes = "xyz";
  // The rest pose lies, and the first frame does not show a standing person.
  if (rest_lies && !standing.value_or(false)) {
    findings.push_back(lying(name, fmt::format("a rest pose that is upright along {}", axes[up]),
                             fmt::format("a pose that is upright along {}", axes[other]),
                             axes[other]));
  } else if (!rest_lies && !standing.value_or(true)) {
    findings.push_back(lying(
        name, fmt::format("a first frame that is upright along {}, like the rest pose", axes[up]),
        fmt::format("a pose that is upright along {}", axes[other]), axes[other]));
  }
  // If the rest pose stands along the other axis, its height is measured along that axis.
  if (rest_lies) up = other;
  // The root is at the origin of the box, so the box's lower end gives the height of the hips above
  // the lowest joint.
  const double hip = -rest.min()[up];
  if (hip < 0.6 || hip > 1.3) {
    const Unit& unit = best_unit(hip / options.metres_per_unit);
    const bool same = unit.metres == options.metres_per_unit;
    add_warning(
        findings,
        {std::string(name), 0, "hips 0.6 to 1.3 m above the lowest joint of the rest pose",
         fmt::format("{:.3g} m", hip)},
        same ? "no other usual unit fits better: the person is small or large, or the rest pose "
               "is unusual"
             : "all lengths may be in another unit",
        same ? "set --metres-per-unit (metres_per_unit in a manifest) if the file has another unit"
             : fmt::format("set --metres-per-unit {0} (metres_per_unit = {0} in a manifest) if "
                           "the file is in {1}",
                           unit.metres, unit.name));
  }
  return findings;
}

}  // namespace kinalign
