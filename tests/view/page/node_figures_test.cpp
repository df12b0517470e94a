// SPDX-License-Identifier: Apache-2.0
// Nodes on bones whose motion is a closed formula.
#include "kinalign/view/page/node_figures.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace kinalign;

namespace {

constexpr double gravity = 9.80665;
const Skeleton body{
    {"Hips", "LeftForeArm", "LeftHand"}, {-1, 0, 1}, {{0, 1, 0}, {0.2, 0.4, 0}, {0.25, 0, 0}}, {}};

Quat turn(const Vec3& axis, double angle) { return Quat(Eigen::AngleAxisd(angle, axis)); }

/// The hips stand still. The forearm turns about two axes, so a node's mounting can be found.
struct Arm {
  double rate = 2.0;  // rad/s
  Quat forearm(double t) const {
    return turn(Vec3::UnitZ(), rate * t) * turn(Vec3::UnitX(), 0.5 * std::sin(rate * t));
  }
  Vec3 hand(double t) const { return Vec3(0.2, 1.4, 0.0) + forearm(t) * Vec3(0.25, 0.0, 0.0); }
};

/// Derivatives from differences over a thousandth of a second, as an independent way.
Vec3 rate_of(const Arm& arm, double t) {
  const double h = 1e-3;
  const Quat step = arm.forearm(t - h).conjugate() * arm.forearm(t + h);
  const Eigen::AngleAxisd angle(step);
  return angle.axis() * angle.angle() / (2.0 * h);
}
Vec3 acceleration_of(const Arm& arm, double t) {
  const double h = 1e-3;
  return (arm.hand(t - h) - 2.0 * arm.hand(t) + arm.hand(t + h)) / (h * h);
}

ClipRows clip_rows(const Arm& arm, const std::vector<double>& times) {
  ClipRows rows;
  for (const double t : times) {
    for (const Vec3& p : body.rest_offsets) {
      for (const double x : {p.x(), p.y(), p.z()}) rows.local_positions.push_back(x);
    }
    for (const Quat& q : {Quat::Identity(), arm.forearm(t), Quat::Identity()}) {
      for (const double x : {q.w(), q.x(), q.y(), q.z()}) rows.local_rotations.push_back(x);
    }
  }
  return rows;
}

/// A node on the forearm: its mounting is `sensor`, and its world is turned by `world`.
struct Worn {
  Quat sensor = turn(Vec3(1, 2, 3).normalized(), 0.7);  // bone_from_sensor
  Quat world = turn(Vec3::UnitY(), 1.1);
  double late_s = 0.0;

  NodeReading reading(const Arm& arm, double now) const {
    const double t = now - late_s;
    NodeReading out;
    out.valid = true;
    out.orientation = world * arm.forearm(t) * sensor;
    out.rate = sensor.conjugate() * rate_of(arm, t);
    const Vec3 force = acceleration_of(arm, t) + Vec3(0.0, gravity, 0.0);
    out.acceleration = sensor.conjugate() * (arm.forearm(t).conjugate() * force);
    return out;
  }
};

ImuRows imu_rows(const Arm& arm, const Worn& worn, const std::vector<double>& times) {
  ImuRows rows;
  for (const double t : times) {
    const NodeReading r = worn.reading(arm, t);
    for (const double x :
         {r.orientation.w(), r.orientation.x(), r.orientation.y(), r.orientation.z()}) {
      rows.orientation.push_back(x);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      rows.angular_velocity.push_back(r.rate[static_cast<Eigen::Index>(k)]);
      rows.acceleration.push_back(r.acceleration[static_cast<Eigen::Index>(k)]);
    }
    rows.valid.push_back(1);
  }
  return rows;
}

std::vector<double> grid(std::size_t rows, double rate_hz) {
  std::vector<double> out;
  for (std::size_t k = 0; k < rows; ++k) out.push_back(static_cast<double>(k) / rate_hz);
  return out;
}

const ImuContent everything{true, true, true, true};

NodeFigures compared(const std::string& node, const Arm& arm, const Worn& worn,
                     std::size_t stride = 1) {
  const auto times = grid(600, 60.0);
  const ClipRows clip = clip_rows(arm, times);
  const ImuRows imu = imu_rows(arm, worn, times);
  NodeCompare compare({{node}, everything, ""}, body, 60.0);
  for (std::size_t k = 0; k < times.size(); ++k) {
    compare.add(times[k], clip, imu, k, k % stride == 0);
  }
  const auto all = compare.finish(static_cast<double>(stride) / 60.0);
  REQUIRE(all.size() == 1);
  return all.front();
}

}  // namespace

TEST_CASE("a bone that turns at a steady rate has that rate, and its end the centripetal force") {
  std::vector<TimedPose> poses(7);
  std::vector<const TimedPose*> pointers;
  const double rate = 1.5, length = 0.3;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double t = (static_cast<double>(k) - 3.0) / 120.0;
    const Quat q = turn(Vec3::UnitY(), rate * t);
    poses[k] = {t, {{q * Vec3(length, 0, 0)}, {q}}};
    pointers.push_back(&poses[k]);
  }
  const BoneReading bone = bone_reading(pointers, 3, {0, 0});
  CHECK((bone.rate - Vec3(0, rate, 0)).norm() < 1e-12);
  // A parabola through a circle over 50 ms is too small by (rate * window)^2 / 14, which is 0.04 %.
  CHECK((bone.acceleration - Vec3(-rate * rate * length, 0, 0)).norm() <
        1e-3 * rate * rate * length);
}

TEST_CASE("a node that measures what its bone does has no residual, however it is strapped on") {
  const NodeFigures node = compared("wrist_left", Arm{}, Worn{});
  CHECK(node.joint == "LeftForeArm");
  CHECK(node.joint_by_name);
  CHECK(node.rows == 600);
  // The parabolas smooth over 50 ms to each side, which changes a motion at 2 rad/s by 0.5 %.
  CHECK(node.rate_rms < 0.02);
  CHECK(node.rate_correlation > 0.99);
  CHECK(node.acceleration_rms < 0.02);
  CHECK(node.orientation_rms < 1e-6);
  REQUIRE(node.lag_s);
  CHECK(std::abs(*node.lag_s) < 1e-3);
}

TEST_CASE("a node's axes stand in the take's space as the bone and the mounting have them") {
  const Arm arm;
  const Worn worn;
  const NodeFigures node = compared("wrist_left", arm, worn);
  const std::size_t k = 100;
  const Quat want = arm.forearm(100.0 / 60.0) * worn.sensor;
  const float* q = &node.axes[4 * k];
  const Quat axes(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]),
                  static_cast<double>(q[3]));
  CHECK(axes.angularDistance(want) < 1e-5);
}

TEST_CASE("a node that is 30 ms late says so, also where every second row is kept") {
  for (const std::size_t stride : {std::size_t{1}, std::size_t{2}}) {
    Worn worn;
    worn.late_s = 0.03;
    const NodeFigures node = compared("wrist_left", Arm{}, worn, stride);
    REQUIRE(node.lag_s);
    CHECK(std::abs(*node.lag_s - 0.03) < 2e-3);
  }
}

TEST_CASE("a node of an unknown name is compared with the joint that turns most like it") {
  const NodeFigures node = compared("number 7", Arm{}, Worn{});
  CHECK(!node.joint_by_name);
  CHECK(node.joint == "LeftForeArm");
  CHECK(node.orientation_rms < 1e-6);
}

TEST_CASE("the step into the root node's space is undone exactly") {
  const Quat root = turn(Vec3(1, 1, 0).normalized(), 0.4), node = turn(Vec3::UnitX(), -1.2);
  const Vec3 root_force(0.3, 9.7, -0.2), force(1.0, 8.0, 2.0), rate(0.4, -0.1, 0.2);
  ImuRows rows;
  const Quat relative = root.conjugate() * node;
  const Vec3 root_rate(0.1, 0.2, 0.3);
  rows.orientation = {root.w(),     root.x(),     root.y(),     root.z(),
                      relative.w(), relative.x(), relative.y(), relative.z()};
  const Vec3 a = relative * force - root_force, w = relative * rate;
  rows.acceleration = {root_force.x(), root_force.y(), root_force.z(), a.x(), a.y(), a.z()};
  rows.angular_velocity = {root_rate.x(), root_rate.y(), root_rate.z(), w.x(), w.y(), w.z()};
  rows.valid = {1, 1};
  const auto readings = node_readings({{"waist", "wrist"}, everything, "waist"}, rows, 0);
  REQUIRE(readings.size() == 2);
  CHECK(readings[1].orientation.angularDistance(node) < 1e-12);
  CHECK((readings[1].acceleration - force).norm() < 1e-12);
  CHECK((readings[1].rate - rate).norm() < 1e-12);
  CHECK((readings[0].acceleration - root_force).norm() < 1e-12);
}

TEST_CASE("names of nodes lead to bones") {
  const std::vector<std::string> joints{"Hips",     "LeftForeArm", "LeftHand",
                                        "RightLeg", "RightFoot",   "Head"};
  const auto turns = [&](const char* node) {
    const auto worn = worn_on(node, joints);
    return worn ? joints[worn->turns] + " " + joints[worn->place] : std::string("none");
  };
  CHECK(turns("waist") == "Hips Hips");
  CHECK(turns("wrist_left") == "LeftForeArm LeftHand");
  CHECK(turns("L_Wrist") == "LeftForeArm LeftHand");
  CHECK(turns("ankle_right") == "RightLeg RightFoot");
  CHECK(turns("R_LowLeg2") == "RightLeg RightFoot");
  CHECK(turns("wrist_right") == "none");
  CHECK(turns("wrist") == "none");
  CHECK(turns("7") == "none");
}
