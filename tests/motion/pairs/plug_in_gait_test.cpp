// SPDX-License-Identifier: Apache-2.0
// Joint centres from invented markers. tests/apps/dataset_import_check.py compares real ones with
// the protocol's own script.
#include "kinalign/motion/pairs/plug_in_gait.h"

#include "kinalign/motion/arrays.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

using namespace kinalign;

namespace {

constexpr std::size_t marker_count = plug_in_gait_markers.size();

struct Markers {
  std::vector<double> positions;
  std::vector<std::uint8_t> seen;

  MarkerFrames frames() const { return {positions, seen}; }
};

std::size_t marker(std::string_view name) {
  return static_cast<std::size_t>(
      std::find(plug_in_gait_markers.begin(), plug_in_gait_markers.end(), name) -
      plug_in_gait_markers.begin());
}

/// Markers about a standing person, x forward, y left, z up, each within 5 cm of its place.
Markers standing(std::size_t frames, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> jitter(-0.05, 0.05);
  const std::map<std::string, Vec3> middle{
      {"FHD", {0.1, 0.1, 1.7}},   {"BHD", {-0.1, 0.1, 1.7}},  {"SHO", {0.0, 0.2, 1.5}},
      {"UPA", {0.0, 0.3, 1.35}},  {"ELB", {0.0, 0.35, 1.2}},  {"FRM", {0.05, 0.4, 1.1}},
      {"WRA", {0.1, 0.4, 1.0}},   {"WRB", {0.0, 0.4, 1.0}},   {"FIN", {0.0, 0.4, 0.9}},
      {"ASI", {0.1, 0.13, 1.0}},  {"PSI", {-0.1, 0.05, 1.0}}, {"THI", {0.0, 0.25, 0.75}},
      {"KNE", {0.0, 0.18, 0.5}},  {"TIB", {0.0, 0.22, 0.3}},  {"ANK", {0.0, 0.15, 0.1}},
      {"HEE", {-0.1, 0.1, 0.05}}, {"TOE", {0.15, 0.1, 0.05}}};
  const std::map<std::string, Vec3> trunk{{"C7", {-0.05, 0.0, 1.5}},
                                          {"T10", {-0.1, 0.0, 1.2}},
                                          {"CLAV", {0.1, 0.0, 1.45}},
                                          {"STRN", {0.1, 0.0, 1.25}},
                                          {"RBAK", {-0.1, -0.1, 1.35}}};
  Markers out;
  for (std::size_t t = 0; t < frames; ++t) {
    for (const std::string_view name : plug_in_gait_markers) {
      const std::string own(name);
      Vec3 place = trunk.contains(own) ? trunk.at(own) : middle.at(own.substr(1));
      if (!trunk.contains(own) && own[0] == 'R') place.y() = -place.y();
      for (double& c : place) out.positions.push_back(c + jitter(random));
      out.seen.push_back(1);
    }
  }
  return out;
}

constexpr FunctionalShifts some_shifts{{0.02, 0.03, -0.01}, {0.01, 0.04, 0.02}};

/// The shared_joints that are not valid in frame 0 without some marker.
std::vector<std::string> lost_without(const std::string& name) {
  Markers markers = standing(3, 1);
  markers.seen[marker(name)] = 0;
  const JointCentres joints = joint_centres(markers.frames(), {});
  std::vector<std::string> lost;
  for (std::size_t j = 0; j < shared_joint_count; ++j) {
    if (joints.valid[j] == 0) lost.emplace_back(shared_joints[j]);
    CHECK(joints.valid[shared_joint_count + j] == 1);
  }
  return lost;
}

}  // namespace

TEST_CASE("turned and moved markers give turned and moved joints") {
  const Markers markers = standing(20, 2);
  const Quat turn = Quat(0.3, -0.5, 0.7, 0.2).normalized();
  const Vec3 move(1.0, -2.0, 3.0);
  Markers moved = markers;
  for (std::size_t i = 0; i < markers.seen.size(); ++i) {
    vec3(moved.positions, i) = turn * Vec3(vec3(markers.positions, i)) + move;
  }
  const JointCentres a = joint_centres(markers.frames(), some_shifts);
  const JointCentres b = joint_centres(moved.frames(), some_shifts);
  for (std::size_t i = 0; i < a.valid.size(); ++i) {
    const Vec3 wanted = turn * Vec3(vec3(a.positions, i)) + move;
    CHECK((vec3(b.positions, i) - wanted).norm() < 1e-12);  // only rounding
  }
}

TEST_CASE("mirrored markers give mirrored joints") {
  const Markers markers = standing(20, 3);
  Markers mirrored = markers;
  for (std::size_t i = 0; i < markers.seen.size(); ++i) {
    std::string name(plug_in_gait_markers[i % marker_count]);
    if (name != "RBAK" && (name[0] == 'L' || name[0] == 'R')) name[0] = name[0] == 'L' ? 'R' : 'L';
    auto to = vec3(mirrored.positions, i - i % marker_count + marker(name));
    to = Vec3(vec3(markers.positions, i)).cwiseProduct(Vec3(1.0, -1.0, 1.0));
  }
  const JointCentres a = joint_centres(markers.frames(), some_shifts);
  const JointCentres b = joint_centres(mirrored.frames(), {some_shifts.right, some_shifts.left});
  constexpr std::array<std::size_t, shared_joint_count> partner{0, 1,  2,  3,  7,  8,  9,  4,  5,
                                                                6, 14, 15, 16, 17, 10, 11, 12, 13};
  for (std::size_t i = 0; i < a.valid.size(); ++i) {
    const std::size_t other = i - i % shared_joint_count + partner[i % shared_joint_count];
    const Vec3 wanted = Vec3(vec3(a.positions, i)).cwiseProduct(Vec3(1.0, -1.0, 1.0));
    CHECK((vec3(b.positions, other) - wanted).norm() < 1e-12);
  }
}

TEST_CASE("a joint without one of its markers is not valid, and the others are") {
  using Names = std::vector<std::string>;
  CHECK(lost_without("LFHD") == Names{"Head"});
  CHECK(lost_without("T10") == Names{"SpineMid", "ShoulderLeft", "ShoulderRight"});
  CHECK(lost_without("LELB") == Names{"ElbowLeft"});
  CHECK(lost_without("RWRB") == Names{"WristRight"});
  CHECK(lost_without("RTIB") == Names{"AnkleRight"});
  CHECK(lost_without("LTHI") == Names{"KneeLeft", "AnkleLeft"});
  CHECK(lost_without("LPSI") == Names{"SpineBase", "HipLeft", "KneeLeft", "AnkleLeft", "HipRight",
                                      "KneeRight", "AnkleRight"});
  CHECK(lost_without("RBAK").empty());
}

TEST_CASE("the elbow goes where the forearm keeps its length") {
  // The true elbow is 3 cm from its marker towards the shoulder; the forearm is 25 cm long.
  Markers markers = standing(200, 4);
  const JointCentres before = joint_centres(markers.frames(), {});
  for (std::size_t t = 0; t < 200; ++t) {
    const Vec3 shoulder = vec3(before.positions, t * shared_joint_count + 4);
    auto cell = [&](std::string_view name) {
      return vec3(markers.positions, t * marker_count + marker(name));
    };
    const Vec3 skin = cell("LELB");
    const Vec3 elbow = skin + 0.03 * (shoulder - skin).normalized();
    const Vec3 wrist = elbow + 0.25 * (Vec3(cell("LWRA")) - elbow).normalized();
    cell("LWRA") = wrist;
    cell("LWRB") = wrist;
  }
  CHECK(functional_shifts(markers.frames()).left.elbow_m == doctest::Approx(0.03).epsilon(1e-3));
}

TEST_CASE("invalid joints lie between the valid frames around, and stay marked") {
  JointCentres joints{std::vector<double>(5 * 3 * shared_joint_count),
                      std::vector<std::uint8_t>(5 * shared_joint_count, 1)};
  const auto place = [&joints](std::size_t t) {
    return vec3(joints.positions, t * shared_joint_count + 6);
  };
  for (const std::size_t t : {0, 2, 3}) joints.valid[t * shared_joint_count + 6] = 0;
  place(1) = Vec3(1.0, 2.0, 3.0);
  place(4) = Vec3(4.0, 5.0, 9.0);
  fill_invalid(joints);
  CHECK((place(0) - place(1)).norm() == 0.0);
  CHECK((place(2) - Vec3(2.0, 3.0, 5.0)).norm() < 1e-15);
  CHECK((place(3) - Vec3(3.0, 4.0, 7.0)).norm() < 1e-15);
  CHECK(joints.valid[2 * shared_joint_count + 6] == 0);
}
