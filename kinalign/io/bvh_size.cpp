// SPDX-License-Identifier: Apache-2.0
// No BVH says its unit or its up axis: whether the values assumed give a person who stands.
#include "kinalign/io/bvh.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace kinalign {

namespace {

struct Extent {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // of the rest pose from its first root, m

  double size(int axis) const { return high[axis] - low[axis]; }
};

/// The rest pose: all rotations the identity, in the axes of the file.
Extent rest_extent(const Skeleton& skeleton) {
  std::vector<Vec3> at(skeleton.joints(), Vec3::Zero());
  Extent extent;
  const auto cover = [&extent](const Vec3& p) {
    extent.low = extent.low.cwiseMin(p);
    extent.high = extent.high.cwiseMax(p);
  };
  for (std::size_t j = 0; j < skeleton.joints(); ++j) {
    const int parent = skeleton.parents[j];
    if (parent >= 0) at[j] = at[static_cast<std::size_t>(parent)] + skeleton.rest_offsets[j];
    cover(at[j]);
  }
  for (const EndSite& site : skeleton.end_sites) {
    cover(at[static_cast<std::size_t>(site.parent)] + site.offset);
  }
  return extent;
}

struct Unit {
  double metres;
  std::string_view name;
};

// Units met in the wild (docs/formats/bvh.md); the last one is the CMU database's.
constexpr std::array<Unit, 5> units{{{0.01, "centimetres"},
                                     {1.0, "metres"},
                                     {0.001, "millimetres"},
                                     {0.0254, "inches"},
                                     {0.056444, "CMU units of 5.64 cm"}}};

/// The unit in which a hip height is nearest to a grown person's 0.9 m.
const Unit& best_unit(double hip_in_units) {
  const Unit* best = units.data();
  for (const Unit& unit : units) {
    const auto off = [hip_in_units](const Unit& u) {
      return std::abs(hip_in_units * u.metres - 0.9);
    };
    if (off(unit) < off(*best)) best = &unit;
  }
  return *best;
}

}  // namespace

Findings judge_size(const Skeleton& skeleton, const BvhOptions& options, std::string_view name) {
  constexpr std::size_t body = 10;  // fewer joints are no whole person
  constexpr int y = 1, z = 2;
  Findings findings;
  if (skeleton.joints() < body) return findings;
  const Extent extent = rest_extent(skeleton);
  int up = options.z_up ? z : y;
  const int other = options.z_up ? y : z;
  if (extent.size(up) < 0.5 * extent.size(other)) {
    findings.push_back(
        {Severity::warning,
         Error{std::string(name), 0, fmt::format("a rest pose that stands along {}", "xyz"[up]),
               fmt::format("one that lies along {}", "xyz"[other])},
         "the person is read as lying",
         fmt::format("--up {0} (up = \"{0}\" in a manifest) turns it upright", "xyz"[other])});
    up = other;
  }
  const double hip = -extent.low[up];
  if (hip < 0.6 || hip > 1.3) {
    const Unit& unit = best_unit(hip / options.metres_per_unit);
    const bool same = unit.metres == options.metres_per_unit;
    findings.push_back(
        {Severity::warning,
         Error{std::string(name), 0, "hips 0.6 to 1.3 m above the lowest joint of the rest pose",
               fmt::format("{:.3g} m", hip)},
         same ? "no other usual unit fits better: a small or large person, or an odd rest pose"
              : "all lengths may be in another unit",
         same ? "--metres-per-unit (metres_per_unit in a manifest) if the file's unit is known to "
                "be "
                "another"
              : fmt::format("--metres-per-unit {0} (metres_per_unit = {0} in a manifest) if the "
                            "file is in {1}",
                            unit.metres, unit.name)});
  }
  return findings;
}

}  // namespace kinalign
