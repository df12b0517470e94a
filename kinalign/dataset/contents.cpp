// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/contents.h"

#include "kinalign/motion/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace kinalign {

namespace {

// These limits are described in contents.h.
constexpr double unit_slack = 1e-3;
constexpr double bone_slack_m = 0.02, bone_slack = 0.05;
constexpr double farthest_m = 100.0, fastest_m_s2 = 1000.0, fastest_rad_s = 100.0;
constexpr double step_slack = 0.5;          // share of a step
constexpr std::uint64_t steps_share = 100;  // one step in this number may differ

double length_of(const double* v) { return std::hypot(v[0], v[1], v[2]); }

/// True if the quaternion w,x,y,z has length 1 within the slack.
bool is_unit(const double* q) {
  const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return std::abs(std::sqrt(square) - 1.0) <= unit_slack;
}

bool finite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

/// A finding without advice, because in all cases the take has to be made again.
Finding finding(Severity severity, const std::string& file, std::string expected,
                std::string found) {
  return {severity, Error{file, 0, std::move(expected), std::move(found)}, "", ""};
}

}  // namespace

/// Prepares the counts of each group. Only bones of skeletons have limits of length.
ContentCheck::ContentCheck(const TakeHeader& header, double rate_hz)
    : step_ns_(rate_hz > 0.0 ? 1e9 / rate_hz : 0.0) {
  for (const TakeGroup& of_take : header.groups) {
    Group& group = groups_.emplace_back();
    group.name = of_take.name;
    if (const auto* clip = std::get_if<ClipGroup>(&of_take.kind)) {
      group.parents = clip->skeleton.parents;
      // Any length is shorter than infinity, so the first one counts.
      group.least.assign(group.parents.size(), std::numeric_limits<double>::infinity());
      group.most.assign(group.parents.size(), 0.0);
      group.global_least = group.least;
      group.global_most = group.most;
    }
  }
}

/// Counts stamps that do not rise, and steps that differ from the step of the rate.
void ContentCheck::add_stamps(const std::vector<Time>& stamps) {
  for (const Time stamp : stamps) {
    const std::int64_t t = to_ns(stamp);
    if (last_ns_ != INT64_MIN) {
      const auto step = static_cast<double>(t) - static_cast<double>(last_ns_);
      ++steps_;
      not_rising_ += t <= last_ns_ ? 1 : 0;
      uneven_ += step_ns_ > 0.0 && std::abs(step - step_ns_) > step_slack * step_ns_ ? 1 : 0;
    }
    last_ns_ = t;
  }
}

void ContentCheck::add_bone(const ClipRows& rows, std::size_t cell, std::size_t parent_cell,
                            std::size_t joint, Group& group) {
  // The length is measured twice, because in a take of another program the local and the global
  // positions may disagree.
  const double bone = length_of(&rows.local_positions[3 * cell]);
  group.least[joint] = std::min(group.least[joint], bone);
  group.most[joint] = std::max(group.most[joint], bone);
  const Vec3 between = vec3(rows.positions, cell) - vec3(rows.positions, parent_cell);
  group.global_least[joint] = std::min(group.global_least[joint], between.norm());
  group.global_most[joint] = std::max(group.global_most[joint], between.norm());
}

/// Counts wrong numbers of a skeleton (contents.h), and measures its bones.
void ContentCheck::add_rows(const ClipRows& rows, std::size_t count, Group& group) const {
  const std::size_t joints = group.parents.size();
  for (std::size_t r = 0; r < count; ++r) {
    // Invalid rows may have any values.
    if (!rows.valid.empty() && rows.valid[r] == 0) continue;
    for (std::size_t j = 0; j < joints; ++j) {
      const std::size_t cell = r * joints + j;
      const double* place = &rows.positions[3 * cell];
      const double* local = &rows.local_positions[3 * cell];
      const double* turn = &rows.local_rotations[4 * cell];
      if (!finite({place, 3}) || !finite({local, 3}) || !finite({turn, 4})) {
        ++group.not_finite;
        continue;
      }
      group.not_unit += is_unit(turn) ? 0 : 1;
      group.far += length_of(place) > farthest_m ? 1 : 0;
      // A root has no bone.
      if (group.parents[j] < 0) continue;
      add_bone(rows, cell, r * joints + static_cast<std::size_t>(group.parents[j]), j, group);
    }
  }
}

/// Counts wrong numbers of valid points (contents.h).
void ContentCheck::add_rows(const PointRows& rows, std::size_t, Group& group) const {
  for (std::size_t cell = 0; cell < rows.valid.size(); ++cell) {
    if (rows.valid[cell] == 0) continue;
    const double* place = &rows.positions[3 * cell];
    if (!finite({place, 3})) {
      ++group.not_finite;
    } else {
      group.far += length_of(place) > farthest_m ? 1 : 0;
    }
  }
}

void ContentCheck::add_vector(const std::vector<double>& all, std::size_t cell, double most,
                              Group& group) {
  if (all.empty()) return;
  const double* v = &all[3 * cell];
  if (!finite({v, 3})) {
    ++group.not_finite;
  } else {
    group.fast += length_of(v) > most ? 1 : 0;
  }
}

/// Counts wrong numbers of valid samples (contents.h).
void ContentCheck::add_rows(const ImuRows& rows, std::size_t, Group& group) const {
  for (std::size_t cell = 0; cell < rows.valid.size(); ++cell) {
    if (rows.valid[cell] == 0) continue;
    add_vector(rows.acceleration, cell, fastest_m_s2, group);
    add_vector(rows.angular_velocity, cell, fastest_rad_s, group);
    if (rows.orientation.empty()) continue;
    const double* turn = &rows.orientation[4 * cell];
    group.not_finite += finite({turn, 4}) ? 0 : 1;
    group.not_unit += finite({turn, 4}) && !is_unit(turn) ? 1 : 0;
  }
}

/// Slabs must be added in order, because stamps are compared across their borders.
void ContentCheck::add(const TakeSlab& slab) {
  add_stamps(slab.stamps);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    std::visit([&](const auto& rows) { add_rows(rows, slab.stamps.size(), groups_[g]); },
               slab.rows[g]);
  }
}

Findings ContentCheck::findings(const std::string& file) const {
  Findings out;
  // A count of 0 is no finding.
  const auto report = [&](Severity severity, std::uint64_t count, const std::string& expected,
                          const std::string& found) {
    if (count > 0)
      out.push_back(finding(severity, file, expected, fmt::format("{} {}", count, found)));
  };
  report(Severity::error, not_rising_, "rising stamps", "that do not rise");
  // Single uneven steps are usual, for example after a lost frame.
  if (uneven_ * steps_share > steps_) {
    report(Severity::warning, uneven_, fmt::format("steps of {:.3f} ms", 1e-6 * step_ns_),
           fmt::format("of {} have another length", steps_));
  }
  for (const Group& group : groups_) {
    report(Severity::error, group.not_finite, "finite values in '" + group.name + "'",
           "NaN or infinite values");
    report(Severity::error, group.not_unit, "rotations of length 1 in '" + group.name + "'",
           "of other length");
    report(Severity::warning, group.far, "positions within 100 m in '" + group.name + "'",
           "farther away");
    report(Severity::warning, group.fast,
           "accelerations within 1000 m/s2 and angular velocities within 100 rad/s in '" +
               group.name + "'",
           "larger values");
    std::uint64_t stretched = 0;
    double worst = 0.0;
    for (std::size_t j = 0; j < group.least.size(); ++j) {
      // The larger change of the two measured lengths counts.
      const double by =
          std::max(group.most[j] - group.least[j], group.global_most[j] - group.global_least[j]);
      if (!(by > std::max(bone_slack_m, bone_slack * group.most[j]))) continue;
      ++stretched;
      worst = std::max(worst, by);
    }
    report(Severity::warning, stretched, "bones of constant length in '" + group.name + "'",
           fmt::format("bones that change, by up to {:.1f} cm", 100.0 * worst));
  }
  return out;
}

}  // namespace kinalign
