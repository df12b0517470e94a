// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/node_errors.h"

#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr double gravity = 9.81;  // m/s2
constexpr double drift_deg_of_a_minute = 3.0;

double radians_of(double degrees) { return degrees * std::numbers::pi / 180.0; }

/// Random numbers of one stream, in order.
class Draws {
 public:
  explicit Draws(const RandomStream& random) : random_(random) {}
  // Normal numbers come in pairs; the second one is kept for the next call.
  float normal(double sigma) {
    if (!has_second_) {
      const auto [first, second] = random_.normals(next_++, 0);
      second_ = second;
      has_second_ = true;
      return static_cast<float>(sigma * first);
    }
    has_second_ = false;
    return static_cast<float>(sigma * second_);
  }
  double uniform() { return random_.uniform(next_++, 0); }

 private:
  const RandomStream& random_;
  std::uint64_t next_ = 0;
  double second_ = 0.0;
  bool has_second_ = false;
};

Eigen::Quaternionf turned_by_vector(const Eigen::Vector3f& vector) {
  const float angle = vector.norm();
  if (angle < 1e-12F) return Eigen::Quaternionf::Identity();
  return Eigen::Quaternionf(Eigen::AngleAxisf(angle, vector / angle));
}

/// Errors of one node that are constant over all frames. `world` rotates the node's world; `mount`
/// is a rotation between node and bone. They act like Y and M in models/pose/node_calibration.h.
struct NodeError {
  // The orientation is multiplied by `world` from the left and by `mount` from the right.
  Eigen::Quaternionf world, mount;
  Eigen::Vector3f leak;  // m/s2, gravity left in the acceleration
  bool lost = false;
};

NodeError draw_error(const NodeErrors& errors, Draws& draws) {
  const double mount = radians_of(errors.mount_deg), tilt = radians_of(errors.tilt_deg);
  // One statement for each number: C++ does not define the order in which arguments are evaluated.
  Eigen::Vector3f mount_vector, tilt_vector = Eigen::Vector3f::Zero();
  for (float& value : mount_vector) value = draws.normal(mount);
  tilt_vector.x() = draws.normal(tilt);
  tilt_vector.z() = draws.normal(tilt);
  // The heading error after a calibration is uniform within its bounds. Drift is a random walk, so
  // it is normal.
  const double heading = radians_of(errors.yaw_deg) * (2.0 * draws.uniform() - 1.0) +
                         static_cast<double>(draws.normal(radians_of(errors.drift_deg)));
  const Eigen::Vector3f yaw_vector(0.0F, static_cast<float>(heading), 0.0F);
  NodeError out;
  out.mount = turned_by_vector(mount_vector);
  out.world = turned_by_vector(tilt_vector) * turned_by_vector(yaw_vector);
  // A tilted node subtracts gravity in a wrong direction. `gravity_leak` is the share of this error
  // that stays in the acceleration.
  const Eigen::Vector3f down(0.0F, static_cast<float>(-gravity), 0.0F);
  out.leak = static_cast<float>(errors.gravity_leak) * (out.world * down - down);
  out.lost = draws.uniform() < errors.lost_share;
  return out;
}

/// Applies one node's errors to sample `at` and adds noise.
void put_error(const NodeErrors& errors, const NodeError& error, std::size_t at, Draws& draws,
               NodeFrames& nodes) {
  float* q = &nodes.orientation[4 * at];
  const Eigen::Quaternionf turned =
      error.world * Eigen::Quaternionf(q[0], q[1], q[2], q[3]) * error.mount;
  q[0] = turned.w();
  q[1] = turned.x();
  q[2] = turned.y();
  q[3] = turned.z();
  Eigen::Map<Eigen::Vector3f> acceleration(&nodes.acceleration[3 * at]);
  acceleration = (error.world * Eigen::Vector3f(acceleration) + error.leak).eval();
  Eigen::Map<Eigen::Vector3f> rate(&nodes.angular_velocity[3 * at]);
  rate = (error.mount.conjugate() * Eigen::Vector3f(rate)).eval();
  for (float& value : acceleration) value += draws.normal(errors.acceleration_noise);
  for (float& value : rate) value += draws.normal(errors.angular_noise);
}

}  // namespace

NodeErrors no_node_errors() {
  return {.mount_deg = 0.0,
          .tilt_deg = 0.0,
          .yaw_deg = 0.0,
          .drift_deg = 0.0,
          .gravity_leak = 0.0,
          .acceleration_noise = 0.0,
          .angular_noise = 0.0,
          .lost_share = 0.0};
}

double drift_after(double minutes) { return drift_deg_of_a_minute * std::sqrt(minutes); }

NodeFrames with_errors(NodeFrames nodes, const NodeErrors& errors, const RandomStream& random) {
  Draws draws(random);
  for (std::size_t n = 0; n < nodes.nodes; ++n) {
    const NodeError error = draw_error(errors, draws);
    const bool is_root = n + 1 == nodes.nodes;
    for (std::size_t t = 0; t < nodes.frames(); ++t) {
      put_error(errors, error, t * nodes.nodes + n, draws, nodes);
    }
    // The samples of a lost node are drawn, too, so that the errors of the next nodes do not depend
    // on the loss.
    if (error.lost && !is_root) nodes = without_node(std::move(nodes), n);
  }
  return nodes;
}

NodeFrames without_node(NodeFrames nodes, std::size_t lost) {
  for (std::size_t at = lost; at < nodes.valid.size(); at += nodes.nodes) nodes.valid[at] = 0;
  return nodes;
}

}  // namespace kinalign
