// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/node_calibration.h"

#include "kinalign/motion/mahony.h"
#include "kinalign/motion/rotation.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace kinalign {

namespace {

/// m/s2. Limbs stay below this; without a limit, a saturated sensor would make a network's output
/// arbitrarily large.
constexpr double most_m_s2 = 100.0;

constexpr double still_deg_s = 20.0, least_still_s = 1.0, most_still_s = 3.0;
// The heading is found from an arm only if its mean angle from the T-pose is at least this, rad.
constexpr double least_swing = 0.3;

double in_degrees(double angle) { return angle * 180.0 / std::numbers::pi; }

Quat orientation_at(const WornFrames& worn, std::size_t at) {
  const float* q = &worn.orientation[4 * at];
  return Quat(q[0], q[1], q[2], q[3]).normalized();
}

void put_orientation(const Quat& q, std::size_t at, NodeFrames& out) {
  const std::array<double, 4> values{q.w(), q.x(), q.y(), q.z()};
  for (std::size_t k = 0; k < 4; ++k) out.orientation[4 * at + k] = static_cast<float>(values[k]);
}

Vec3 vector_at(const std::vector<float>& values, std::size_t at) {
  return Eigen::Map<const Eigen::Vector3f>(&values[3 * at]).cast<double>();
}

void put_vector(const Vec3& vector, std::size_t at, std::vector<float>& out) {
  Eigen::Map<Eigen::Vector3f> place(&out[3 * at]);
  place = vector.cast<float>();
}

double turn_deg_s(const WornFrames& worn, std::size_t at) {
  return in_degrees(vector_at(worn.angular_velocity, at).norm());
}

/// True if the root's node is valid and no valid node turns faster than still_deg_s.
bool is_still(const WornFrames& worn, std::size_t t) {
  const std::size_t first = t * worn.nodes;
  if (worn.valid[first + worn.nodes - 1] == 0) return false;
  for (std::size_t at = first; at < first + worn.nodes; ++at) {
    if (worn.valid[at] != 0 && !(turn_deg_s(worn, at) < still_deg_s)) return false;
  }
  return true;
}

/// The mean of a node's samples in the T-pose.
struct RestingNode {
  Quat world_from_node;
  Vec3 zero;  // m/s2, mean acceleration in the node's space
};

/// Means over the valid frames of the T-pose. The node turns by less than a degree there, so the
/// normalised sum of quaternions of one sign is their mean.
std::optional<RestingNode> resting(const WornFrames& worn, const TPose& t_pose, std::size_t node) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  Vec3 zero = Vec3::Zero();
  double count = 0.0;
  for (std::size_t t = t_pose.first; t < t_pose.first + t_pose.count; ++t) {
    const std::size_t at = t * worn.nodes + node;
    if (worn.valid[at] == 0) continue;
    const Quat q = orientation_at(worn, at);
    sum += sum.dot(q.coeffs()) < 0.0 ? -q.coeffs() : q.coeffs();
    zero += q.conjugate() * vector_at(worn.acceleration, at);
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return RestingNode{Quat(Eigen::Vector4d(sum.normalized())), zero / count};
}

Quat about_vertical(double heading) { return rotation(Vec3(0.0, heading, 0.0)); }

/// The mean of angles, and the largest distance of an angle from it.
struct MeanAngle {
  double angle = 0.0, worst = 0.0;  // rad
};

MeanAngle mean_angle(const std::vector<double>& angles) {
  std::complex<double> sum;
  for (const double angle : angles) sum += std::polar(1.0, angle);
  MeanAngle out{std::arg(sum), 0.0};
  for (const double angle : angles) {
    out.worst =
        std::max(out.worst, std::abs(std::remainder(angle - out.angle, 2.0 * std::numbers::pi)));
  }
  return out;
}

/// The heading of the world of an arm's node, from the arm's mean rotation since the T-pose.
/// Rotations of the whole person are removed first. Empty if the arm hardly left the T-pose.
std::optional<double> heading_by_arm(const WornFrames& worn, std::size_t node, const Quat& arm_rest,
                                     const Quat& root_rest, bool is_left) {
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (std::size_t t = 0; t < worn.frames(); ++t) {
    const std::size_t at = t * worn.nodes + node, root = (t + 1) * worn.nodes - 1;
    if (worn.valid[at] == 0 || worn.valid[root] == 0) continue;
    const double turned = heading_of(orientation_at(worn, root) * root_rest.conjugate());
    sum +=
        rotation_vector(about_vertical(-turned) * orientation_at(worn, at) * arm_rest.conjugate());
    count += 1.0;
  }
  if (count == 0.0 || std::hypot(sum.x(), sum.z()) < least_swing * count) return std::nullopt;
  // A left arm that comes down turns about -z, a right arm about +z. The measured axis lies
  // elsewhere by the unknown heading.
  const double is = std::atan2(sum.x(), sum.z()), expected = is_left ? std::numbers::pi : 0.0;
  return expected - is;
}

/// The state of all nodes in the T-pose.
struct Rest {
  std::vector<std::optional<RestingNode>> nodes;  // [N]
  std::vector<Quat> worn;                 // [N] world_from_node for nodes worn as docs/pose.md says
  std::vector<double> heading, tilt_deg;  // [N] from the mounting
};

/// Averages each node over the T-pose and compares it with the orientation expected from
/// docs/pose.md.
Rest rest_of(const PoseLayout& layout, const WornFrames& worn, const CalibrationOptions& options) {
  Rest out;
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
    out.nodes.push_back(resting(worn, options.t_pose, n));
    const bool known = n < options.worn.size() && options.worn[n].has_value();
    out.worn.push_back(known ? *options.worn[n] : worn_in_t_pose(*worn_place(layout.nodes[n])));
    const Quat is = out.nodes[n] ? out.nodes[n]->world_from_node : Quat::Identity();
    const Vec3 up = is.conjugate() * Vec3::UnitY();
    const Vec3 expected = out.worn[n].conjugate() * Vec3::UnitY();
    out.tilt_deg.push_back(in_degrees(std::acos(std::clamp(up.dot(expected), -1.0, 1.0))));
    out.heading.push_back(heading_of(out.worn[n] * is.conjugate()));
  }
  return out;
}

/// Headings by the mounting, of the nodes whose tilt fits the mounting.
std::vector<double> credible_headings(const Rest& rest) {
  std::vector<double> out;
  for (std::size_t n = 0; n < rest.nodes.size(); ++n) {
    if (rest.nodes[n] && rest.tilt_deg[n] <= most_tilt_deg) out.push_back(rest.heading[n]);
  }
  return out;
}

bool are_worn_as_described(const PoseLayout& layout, const Rest& rest) {
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
    if (!rest.nodes[n] || worn_place(layout.nodes[n])->on_arm) continue;
    if (rest.tilt_deg[n] > most_tilt_deg) return false;
  }
  return true;
}

/// The heading shared by all nodes, from arms that come down. Fails if no arm does.
Result<double> heading_by_arms(const PoseLayout& layout, const WornFrames& worn, const Rest& rest) {
  std::vector<double> headings;
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
    if (!rest.nodes[n] || !worn_place(layout.nodes[n])->on_arm) continue;
    const bool is_left = worn_place(layout.nodes[n])->t_pose[0] > 0.0;
    const auto one = heading_by_arm(worn, n, rest.nodes[n]->world_from_node,
                                    rest.nodes.back()->world_from_node, is_left);
    if (one) headings.push_back(*one);
  }
  if (!headings.empty()) return mean_angle(headings).angle;
  return Failure(Error{"", 0, "nodes worn as described in docs/pose.md, or arms that come down",
                       "neither, so the direction of the person is unknown"});
}

}  // namespace

std::optional<TPose> first_still(const WornFrames& worn, double rate_hz) {
  const auto least = static_cast<std::size_t>(std::ceil(least_still_s * rate_hz));
  const auto most = static_cast<std::size_t>(std::ceil(most_still_s * rate_hz));
  TPose run;
  for (std::size_t t = 0; t < worn.frames() && run.count < most; ++t) {
    if (is_still(worn, t)) {
      ++run.count;
    } else if (run.count >= least) {
      break;
    } else {
      run = {t + 1, 0};
    }
  }
  if (run.count < least) return std::nullopt;
  return run;
}

double fastest_turn_deg(const WornFrames& worn, const TPose& t_pose) {
  double out = 0.0;
  const std::size_t end = (t_pose.first + t_pose.count) * worn.nodes;
  for (std::size_t at = t_pose.first * worn.nodes; at < end; ++at) {
    if (worn.valid[at] != 0) out = std::max(out, turn_deg_s(worn, at));
  }
  return out;
}

Result<NodeCalibration> calibrate(const PoseLayout& layout, const Skeleton& body,
                                  const WornFrames& worn, const CalibrationOptions& options) {
  const std::vector<Quat> bones = KA_TRY(t_pose_rotations(layout, body));
  const Rest rest = rest_of(layout, worn, options);
  if (!rest.nodes.back()) {
    return Failure(
        Error{"", 0, "samples of the node " + layout.nodes.back() + " in the T-pose", "none"});
  }
  NodeCalibration out;
  out.worn_as_described = are_worn_as_described(layout, rest);
  const MeanAngle by_mounting = mean_angle(credible_headings(rest));
  out.spread_deg = in_degrees(by_mounting.worst);
  // The rule of `--heading auto` in docs/pose.md. If the user chose `shared` although the headings
  // lie far apart, the root's node alone gives the heading: their mean would be meaningless.
  const bool own = out.worn_as_described && out.spread_deg > most_shared_deg;
  out.headings = options.headings.value_or(own ? Headings::mounting : Headings::shared);
  double shared = own ? rest.heading.back() : by_mounting.angle;
  if (out.headings == Headings::shared && !out.worn_as_described) {
    out.facing = Facing::arms;
    shared = KA_TRY(heading_by_arms(layout, worn, rest));
  }
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
    out.nodes.emplace_back();
    if (!rest.nodes[n]) continue;
    const double heading = out.headings == Headings::shared ? shared : rest.heading[n];
    const Quat turn = about_vertical(heading);
    const Quat node_from_bone =
        rest.nodes[n]->world_from_node.conjugate() * turn.conjugate() * bones[n];
    out.nodes.back() = {turn, node_from_bone, rest.nodes[n]->zero, rest.tilt_deg[n]};
  }
  return out;
}

// Applies bone = Y q M to orientations. Accelerations are in the world, so only Y turns them;
// angular velocities are in the node's space, so only M does.
NodeFrames on_bones(const NodeCalibration& calibration, WornFrames worn) {
  for (std::size_t at = 0; at < worn.valid.size(); ++at) {
    const auto& node = calibration.nodes[at % worn.nodes];
    if (!node) worn.valid[at] = 0;
    if (worn.valid[at] == 0) continue;
    const Quat q = orientation_at(worn, at);
    const Vec3 acceleration = vector_at(worn.acceleration, at) - q * node->zero;
    put_vector(node->heading * acceleration.cwiseMin(most_m_s2).cwiseMax(-most_m_s2), at,
               worn.acceleration);
    put_vector(node->node_from_bone.conjugate() * vector_at(worn.angular_velocity, at), at,
               worn.angular_velocity);
    put_orientation(node->heading * q * node->node_from_bone, at, worn);
  }
  return worn;
}

}  // namespace kinalign
