// SPDX-License-Identifier: Apache-2.0
#include "kinalign/check/orientation_sense.h"

#include "kinalign/motion/arrays.h"
#include "kinalign/motion/rotation.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

/// Nodes with fewer samples are not judged.
constexpr std::uint64_t enough_samples = 50;
/// Chosen limit: for a runner the mean acceleration leans by a few degrees, for a wrong axis by 90.
constexpr double most_lean_deg = 45.0;
/// Slower rotations are hidden by the gyroscope's bias (up to 0.05 rad/s) and by rounded angles.
constexpr double least_turn_rad_s = 0.2;
/// Chosen limit for the correlation. All nodes of a walk in UNSW's data, of the Xsens exports and
/// of the demo are above it. The demo's wrist has -0.16 if x,y,z,w is read as w,x,y,z.
constexpr double least_likeness = 0.5;

}  // namespace

/// Sums gravity in the world's axes, and the rotations by orientations and by gyroscope.
void OrientationSense::add(const ImuSamples& block) {
  if (block.size() == 0 || block.orientation.empty()) return;
  const std::size_t count = block.valid.size() / block.size();
  nodes_.resize(count);
  for (std::size_t cell = 0; cell < block.valid.size(); ++cell) {
    Node& node = nodes_[cell % count];
    if (block.valid[cell] == 0) {
      // After a missing sample, the rotation since the last sample is not known.
      node.last.reset();
      continue;
    }
    Last now{to_ns(block.stamps[cell / count]), quat(block.orientation, cell), Vec3::Zero()};
    ++node.samples;
    // An accelerometer at rest measures an acceleration that points up. The mean over a motion
    // points up too.
    if (!block.acceleration.empty()) node.up += now.q * Vec3(vec3(block.acceleration, cell));
    if (!block.angular_velocity.empty()) {
      now.rate = vec3(block.angular_velocity, cell);
      if (node.last) add_turn(node, now);
    }
    node.last = now;
  }
}

/// Adds the rotation between two samples. Long steps and large rotations are omitted, because the
/// rate may have changed between the samples. Rotations are compared instead of rates, because a
/// step of only 10 us would give a huge rate.
void OrientationSense::add_turn(Node& node, const Last& now) {
  constexpr double longest_s = 0.2, farthest_rad = 1.0, quickest_rad_s = 40.0;  // 2,300 deg/s
  const double seconds = 1e-9 * (static_cast<double>(now.t) - static_cast<double>(node.last->t));
  const Vec3 turn = rotation_vector(node.last->q.conjugate() * now.q);
  if (!(seconds > 0.0) || seconds > longest_s || turn.norm() > farthest_rad) return;
  // The gyroscope's rotation between two samples, computed from the mean of both rates.
  const Vec3 rate = 0.5 * (node.last->rate + now.rate), measured = rate * seconds;
  if (rate.norm() > quickest_rad_s) return;
  ++node.turns;
  node.both += turn.dot(measured);
  node.turned += turn.squaredNorm();
  node.measured += measured.squaredNorm();
  node.times += seconds * seconds;
}

void OrientationSense::judge(const ImuHeader& header, FileFindings& out) const {
  const char* advice = "are the quaternions w,x,y,z, and world_from_sensor? is up the file's axis?";
  for (std::size_t s = 0; s < nodes_.size(); ++s) {
    const Node& node = nodes_[s];
    const std::string name = s < header.node_names.size() ? shown(header.node_names[s]) : "";
    if (header.content.acceleration && header.content.gravity && node.samples >= enough_samples) {
      // The angle between the mean acceleration in the world and the vertical axis +y.
      const double lean = std::atan2(std::hypot(node.up.x(), node.up.z()), node.up.y());
      const double lean_deg = lean * (180.0 / std::numbers::pi);
      if (lean_deg > most_lean_deg) {
        out.add(Severity::warning, "gravity of '" + name + "' that points up in the world",
                fmt::format("a mean of {:.0f} degrees away", lean_deg),
                "orientations and accelerations do not belong together", advice);
      }
    }
    const double least = node.times * least_turn_rad_s * least_turn_rad_s;
    // The correlation is meaningful only with enough samples and with rotations clearly above the
    // bias.
    if (node.turns < enough_samples || node.measured < least) continue;
    // The correlation of both rotations. It is 1 for equal directions and does not depend on scale.
    const double alike = node.both / std::sqrt(std::max(node.turned * node.measured, 1e-300));
    if (alike >= least_likeness) continue;
    out.add(Severity::warning, "orientations of '" + name + "' that turn as the gyroscope measures",
            fmt::format("a correlation of {:.2f} (1: the same turns, 0: unrelated)", alike),
            "orientations and angular velocities do not belong together", advice);
  }
}

}  // namespace kinalign
