// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/node_calibration.h"

#include "tests/models/pose/pose_people.h"
#include "tests/seeds.h"

#include "kinalign/motion/rotation.h"

#include <doctest/doctest.h>

#include <numbers>

using namespace kinalign;

namespace {

constexpr std::size_t worn_count = 5, t_pose_frames = 60, all_frames = 240;
constexpr double pi = std::numbers::pi;

Quat turned(double x, double y, double z) { return rotation(Vec3(x, y, z)); }

/// The nodes' mountings and their worlds.
struct Worn {
  std::vector<Quat> heading, node_from_bone;  // [N] Y and M
};

/// The truth of a person who holds a T-pose for 2 s, lets the arms down, and turns.
struct Person {
  NodeFrames bones;  // the samples that a model must see
  std::vector<Quat> t_pose;
};

void put(const Quat& q, const Vec3& acceleration, const Vec3& rate, NodeFrames& out) {
  append_sample(out, q.cast<float>(), acceleration.cast<float>(), rate.cast<float>());
}

Person person() {
  Person out;
  out.t_pose = *t_pose_rotations(test_layout(), pose_body(test_offsets()).skeleton);
  out.bones.nodes = worn_count;
  for (std::size_t t = 0; t < all_frames; ++t) {
    const double gone = t < t_pose_frames ? 0.0 : static_cast<double>(t - t_pose_frames) / 60.0;
    const double down = std::min(gone, 1.0) * 0.45 * pi, turn = gone * 0.8;
    for (std::size_t n = 0; n < worn_count; ++n) {
      Quat from_t_pose = turned(0.0, turn, 0.0);
      if (n == 0) from_t_pose = from_t_pose * turned(0.0, 0.0, -down);
      if (n == 1) from_t_pose = from_t_pose * turned(0.0, 0.0, down);
      if (n == 2) from_t_pose = from_t_pose * turned(0.5 * std::sin(gone), 0.0, 0.1 * gone);
      const Vec3 moving = gone > 0.0 ? Vec3(std::sin(gone), 0.3 * gone, 1.0) : Vec3::Zero();
      put(from_t_pose * out.t_pose[n], moving, moving, out.bones);
    }
  }
  return out;
}

/// The samples that the nodes send.
WornFrames said(const Person& person, const Worn& worn) {
  WornFrames out;
  out.nodes = worn_count;
  for (std::size_t at = 0; at < all_frames * worn_count; ++at) {
    const std::size_t n = at % worn_count;
    const float* q = &person.bones.orientation[4 * at];
    const Quat back = worn.heading[n].conjugate();
    const Vec3 acceleration =
        Eigen::Map<const Eigen::Vector3f>(&person.bones.acceleration[3 * at]).cast<double>();
    const Vec3 rate =
        Eigen::Map<const Eigen::Vector3f>(&person.bones.angular_velocity[3 * at]).cast<double>();
    put(back * Quat(q[0], q[1], q[2], q[3]) * worn.node_from_bone[n].conjugate(),
        back * acceleration, worn.node_from_bone[n] * rate, out);
  }
  return out;
}

/// The largest difference between two arrays; q and -q count as equal.
double apart(const NodeFrames& a, const NodeFrames& b) {
  double most = 0.0;
  for (std::size_t at = 0; at < a.valid.size(); ++at) {
    const Eigen::Map<const Eigen::Vector4f> p(&a.orientation[4 * at]), q(&b.orientation[4 * at]);
    most = std::max<double>(most, std::min((p - q).norm(), (p + q).norm()));
    for (std::size_t k = 3 * at; k < 3 * at + 3; ++k) {
      most = std::max<double>(most, std::abs(a.acceleration[k] - b.acceleration[k]));
      most = std::max<double>(most, std::abs(a.angular_velocity[k] - b.angular_velocity[k]));
    }
  }
  return most;
}

NodeCalibration calibrated(const WornFrames& worn, std::optional<Headings> how = {}) {
  const auto out = calibrate(test_layout(), pose_body(test_offsets()).skeleton, worn,
                             {.t_pose = {0, t_pose_frames}, .headings = how});
  REQUIRE_MESSAGE(out, to_string(out.error()));
  return *out;
}

Quat any_rotation(std::mt19937_64& random) { return random_turn(random).cast<double>(); }

/// Nodes with random headings, worn as in docs/pose.md, each with an additional turn.
Worn worn_as_described(const Person& person, std::mt19937_64& random, double turn) {
  std::uniform_real_distribution<double> angle(-pi, pi), small(-turn, turn);
  Worn out;
  for (std::size_t n = 0; n < worn_count; ++n) {
    out.heading.push_back(turned(0.0, angle(random), 0.0));
    const Vec3 by(small(random), small(random), small(random));
    const Quat told = worn_in_t_pose(*worn_place(test_layout().nodes[n]));
    out.node_from_bone.push_back((rotation(by) * told).conjugate() * person.t_pose[n]);
  }
  return out;
}

}  // namespace

TEST_CASE("nodes worn anyhow that share a heading are found by arms that come down") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Person truth = person();
    std::uniform_real_distribution<double> angle(-pi, pi);
    const Quat heading = turned(0.0, angle(random), 0.0);
    Worn worn{std::vector<Quat>(worn_count, heading), {}};
    for (std::size_t n = 0; n < worn_count; ++n)
      worn.node_from_bone.push_back(any_rotation(random));
    // This one is surely not worn as in docs/pose.md.
    worn.node_from_bone[2] = Quat(turned(pi, 0.0, 0.0));
    const WornFrames frames_said = said(truth, worn);
    const NodeCalibration found = calibrated(frames_said);
    CHECK(found.headings == Headings::shared);
    CHECK(found.facing == Facing::arms);
    CHECK_FALSE(found.worn_as_described);
    CHECK(apart(on_bones(found, frames_said), truth.bones) < 2e-5);
  }
}

TEST_CASE("nodes worn as described have a heading each, which their mounting shows") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Person truth = person();
    Worn worn = worn_as_described(truth, random, 0.0);
    worn.heading[0] = turned(0.0, 3.0, 0.0);  // these surely differ in heading
    worn.heading[1] = turned(0.0, 0.0, 0.0);
    worn.heading[4] = turned(0.0, -1.5, 0.0);
    const WornFrames frames_said = said(truth, worn);
    const NodeCalibration found = calibrated(frames_said);
    CHECK(found.headings == Headings::mounting);
    CHECK(found.worn_as_described);
    for (const auto& node : found.nodes) CHECK(node->tilt_deg < 0.1);
    CHECK(apart(on_bones(found, frames_said), truth.bones) < 2e-5);
  }
}

TEST_CASE(
    "nodes worn as described in one world share a heading, and errors of wearing are averaged") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Person truth = person();
    Worn worn = worn_as_described(truth, random, 0.15);
    worn.heading.assign(worn_count, worn.heading[0]);
    const WornFrames frames_said = said(truth, worn);
    const NodeCalibration found = calibrated(frames_said);
    CHECK(found.headings == Headings::shared);
    CHECK(found.facing == Facing::mounting);
    // At most the 0.15 rad and the part that their tilt adds. In the T-pose itself all bones are
    // exact.
    CHECK(found.nodes[0]->heading.angularDistance(worn.heading[0]) < 0.25);
    const NodeFrames bones = on_bones(found, frames_said);
    for (std::size_t n = 0; n < worn_count; ++n) {
      const float* q = &bones.orientation[4 * n];
      CHECK(Quat(q[0], q[1], q[2], q[3]).angularDistance(truth.t_pose[n]) < 1e-5);
    }
  }
}

TEST_CASE("a node's turn about the vertical is taken for heading") {
  std::mt19937_64 random(1);
  const Person truth = person();
  Worn worn = worn_as_described(truth, random, 0.0);
  worn.heading[1] = Quat::Identity();
  const Quat told = worn_in_t_pose(*worn_place("wrist_right"));
  worn.node_from_bone[1] = (turned(0.0, 0.2, 0.0) * told).conjugate() * truth.t_pose[1];
  const NodeCalibration found = calibrated(said(truth, worn), Headings::mounting);
  CHECK(found.nodes[1]->heading.angularDistance(turned(0.0, -0.2, 0.0)) < 1e-5);
  CHECK(found.nodes[0]->heading.angularDistance(worn.heading[0]) < 1e-5);
}

TEST_CASE("a heading that is wrong turns a movement about the vertical") {
  std::mt19937_64 random(2);
  const Person truth = person();
  Worn worn = worn_as_described(truth, random, 0.0);
  worn.heading.assign(worn_count, Quat::Identity());
  worn.heading[2] = turned(0.0, 0.5 * pi, 0.0);
  const WornFrames frames_said = said(truth, worn);
  const NodeFrames bones = on_bones(calibrated(frames_said, Headings::mounting), frames_said);
  CHECK(apart(bones, truth.bones) < 2e-5);
  CHECK(apart(on_bones(calibrated(frames_said, Headings::shared), frames_said), truth.bones) > 0.1);
}

TEST_CASE("arms that hang in place of a T-pose are seen by where up is for their nodes") {
  std::mt19937_64 random(3);
  const Person truth = person();
  const Worn worn = worn_as_described(truth, random, 0.0);
  const auto found = calibrate(test_layout(), pose_body(test_offsets()).skeleton, said(truth, worn),
                               {.t_pose = {180, 30}, .headings = Headings::mounting});
  REQUIRE(found);
  CHECK(found->worn_as_described);
  CHECK(found->nodes[0]->tilt_deg == doctest::Approx(81.0).epsilon(0.01));
  CHECK(found->nodes[1]->tilt_deg == doctest::Approx(81.0).epsilon(0.01));
  CHECK(found->nodes[4]->tilt_deg < 1.0);
}

TEST_CASE("an accelerometer's reading at rest is subtracted in its own space") {
  std::mt19937_64 random(4);
  const Person truth = person();
  const Worn worn = worn_as_described(truth, random, 0.0);
  WornFrames wrong = said(truth, worn);
  const Vec3 zero(0.2, -0.3, 0.1);
  for (std::size_t at = 0; at < wrong.valid.size(); at += worn_count) {
    const float* q = &wrong.orientation[4 * at];
    Eigen::Map<Eigen::Vector3f> a(&wrong.acceleration[3 * at]);
    a += (Quat(q[0], q[1], q[2], q[3]) * zero).cast<float>();
  }
  const NodeCalibration found = calibrated(wrong, Headings::mounting);
  CHECK((found.nodes[0]->zero - zero).norm() < 1e-5);
  CHECK(apart(on_bones(found, wrong), truth.bones) < 2e-5);
}

TEST_CASE("a node without samples in the T-pose is lost, and without the root's there is nothing") {
  std::mt19937_64 random(5);
  const Person truth = person();
  WornFrames frames_said = said(truth, worn_as_described(truth, random, 0.0));
  for (std::size_t t = 0; t < t_pose_frames; ++t) frames_said.valid[worn_count * t + 3] = 0;
  const NodeCalibration found = calibrated(frames_said, Headings::mounting);
  CHECK_FALSE(found.nodes[3]);
  const NodeFrames bones = on_bones(found, frames_said);
  for (std::size_t at = 3; at < bones.valid.size(); at += worn_count) CHECK(bones.valid[at] == 0);
  CHECK(bones.valid[worn_count * 100] == 1);
  for (std::size_t t = 0; t < t_pose_frames; ++t) frames_said.valid[worn_count * t + 4] = 0;
  const auto none = calibrate(test_layout(), pose_body(test_offsets()).skeleton, frames_said,
                              {.t_pose = {0, t_pose_frames}});
  CHECK(to_string(none.error()) == "expected samples of the node waist in the T-pose, found none");
}

TEST_CASE("if neither wearing nor arms show it, the direction of the person is unknown") {
  const Person truth = person();
  Worn worn{std::vector<Quat>(worn_count, Quat::Identity()),
            std::vector<Quat>(worn_count, turned(pi, 0.0, 0.0))};
  WornFrames frames_said = said(truth, worn);
  for (std::size_t t = t_pose_frames; t < all_frames; ++t) {
    frames_said.valid[worn_count * t] = frames_said.valid[worn_count * t + 1] = 0;
  }
  const auto none = calibrate(test_layout(), pose_body(test_offsets()).skeleton, frames_said,
                              {.t_pose = {0, t_pose_frames}});
  CHECK(to_string(none.error()) ==
        "expected nodes worn as described in docs/pose.md, or arms that come down, found neither, "
        "so the direction of the person is unknown");
}

TEST_CASE("a stated mounting replaces the described one") {
  const Person truth = person();
  const Worn worn{std::vector<Quat>(worn_count, turned(0.0, 1.0, 0.0)),
                  std::vector<Quat>(worn_count, Quat::Identity())};
  const WornFrames frames_said = said(truth, worn);
  CalibrationOptions options{.t_pose = {0, t_pose_frames}, .headings = Headings::mounting};
  options.worn.assign(truth.t_pose.begin(), truth.t_pose.end());
  const auto found =
      calibrate(test_layout(), pose_body(test_offsets()).skeleton, frames_said, options);
  REQUIRE(found);
  CHECK(apart(on_bones(*found, frames_said), truth.bones) < 2e-5);
}

TEST_CASE("the first still second is found, three at most, with the root's node in it") {
  WornFrames still;
  still.nodes = 2;
  for (int i = 0; i < 600; ++i) {
    append_sample(still, Eigen::Quaternionf::Identity(), Eigen::Vector3f::Zero(),
                  Eigen::Vector3f::Zero());
  }
  const auto turn = [&](std::size_t t, std::size_t n, float rate) {
    still.angular_velocity[3 * (2 * t + n)] = rate;
  };
  turn(20, 0, 0.5F);
  turn(49, 1, 0.5F);
  still.valid[2 * 100 + 1] = 0;
  turn(110, 0, 0.3F);
  const auto found = first_still(still, 30.0);
  REQUIRE(found);
  CHECK(found->first == 50);
  CHECK(found->count == 50);
  CHECK(fastest_turn_deg(still, {101, 20}) == doctest::Approx(0.3 * 180.0 / pi));
  still.valid[2 * 60 + 1] = 0;
  CHECK(first_still(still, 30.0)->first == 61);
  turn(70, 0, 0.5F);
  CHECK(first_still(still, 30.0)->first == 101);
  CHECK(first_still(still, 30.0)->count == 90);
  for (std::size_t t = 0; t < 300; t += 20) turn(t, 1, 0.5F);
  CHECK_FALSE(first_still(still, 30.0));
}
