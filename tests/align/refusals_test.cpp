// SPDX-License-Identifier: Apache-2.0
// A recording that can't be aligned is refused before anything is made, with the names that the
// user gave.
#include "tests/align/two_streams.h"

#include "kinalign/align/align.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace kinalign::test;

namespace {

PointStream hundred() { return points(joints, every(10 * ms, 100), wander); }

ImuStream node(const std::string& name) {
  return nodes({name}, every(10 * ms, 100), [](std::size_t, double) { return Quat::Identity(); });
}

Clip skeleton() {
  Clip clip;
  clip.skeleton = {{"Hips"}, {-1}, {Vec3::Zero()}, {}};
  clip.frames.stamps = every(10 * ms, 100);
  clip.frames.local_positions.assign(300, 0.0);
  for (int i = 0; i < 100; ++i) {
    for (const double part : {1.0, 0.0, 0.0, 0.0}) clip.frames.local_rotations.push_back(part);
  }
  return clip;
}

Recording of(std::vector<RecordedStream> streams) { return {"", "", std::move(streams)}; }

StreamOptions told(const std::string& name) {
  StreamOptions out;
  out.name = name;
  return out;
}

std::string fault(const Recording& recording, const Manifest& manifest = {}) {
  const auto take = align(recording, manifest);
  return take ? "none" : to_string(take.error());
}

/// The error for a manifest that gives the stream "kinect" the options `space`.
std::string fault_of_space(const SpaceOptions& space, PointStream kinect = hundred()) {
  Manifest manifest;
  manifest.spaces["kinect"] = space;
  return fault(two(hundred(), std::move(kinect)), manifest);
}

SpaceOptions by(const std::string& method) {
  SpaceOptions out;
  out.method = method;
  return out;
}

}  // namespace

TEST_CASE("the reference is a stream of the recording, and no nodes") {
  CHECK(fault(of({})) == "expected at least one stream, found none");
  Manifest manifest;
  manifest.align.reference = "mocap";
  CHECK(fault(two(hundred(), hundred()), manifest) ==
        "expected a stream as the reference (known: optical, kinect), found \"mocap\"");
  CHECK(fault(of({recorded("imu", node("waist")), recorded("kinect", hundred())})) ==
        "expected a skeleton or points as the reference (reference = in [align]), found nodes");
}

TEST_CASE("a stream without a sample, or none of the reference in the span, is refused") {
  CHECK(fault(two(hundred(), points(joints, {}, wander))) ==
        "expected at least one sample for stream 'kinect', found none");
  CHECK(
      fault(two(points(joints, every(1000 * ms, 2), wander),
                points(joints, every(10 * ms, 21, 400 * ms), wander))) ==
      "expected frames of 'optical' in the common span, found no frame; optical 0.000 to 1.000 s, "
      "kinect 0.400 to 0.600 s");
  auto late = recorded("imu", node("waist"));
  late.clock.pieces.front().offset = Duration{5000 * ms};
  CHECK(fault(of({recorded("optical", hundred()), late})) ==
        "expected streams that overlap in time (see start_ns and offset_ms), found optical 0.000 "
        "to 0.990 s, imu waist 5.000 to 5.990 s");
}

TEST_CASE("streams share a name only where they are nodes that measure the same") {
  auto named = recorded("kinect", skeleton());
  named.files = {{"walk.bvh", "", 0}};
  CHECK(fault(of({recorded("kinect", hundred()), named})) ==
        "expected streams with different names, found 'kinect' twice: memory (points) and "
        "walk.bvh (a skeleton)");
  CHECK(fault(of({recorded("optical", hundred()), recorded("imu", node("waist")),
                  recorded("imu", hundred())})) ==
        "expected streams with different names, found 'imu' twice: memory (nodes) and memory "
        "(points)");
  CHECK(fault(of({recorded("optical", hundred()), recorded("imu", node("waist")),
                  recorded("imu", node("waist"))})) ==
        "expected nodes with different names, found 'waist' twice");
  ImuStream without_gravity = node("wrist_left");
  without_gravity.content.gravity = false;
  CHECK(fault(of({recorded("optical", hundred()), recorded("imu", node("waist")),
                  recorded("imu", without_gravity)})) ==
        "expected nodes of 'imu' that measure the same quantities, found 'wrist_left', which "
        "measures other quantities");
}

TEST_CASE("a root node is one of the nodes and has an orientation") {
  Manifest manifest;
  manifest.streams = {told("imu")};
  manifest.streams[0].root_node = "hip";
  const auto recording = [](ImuStream imu) {
    return of({recorded("optical", hundred()), recorded("imu", std::move(imu))});
  };
  CHECK(fault(recording(node("waist")), manifest) ==
        "expected a node of 'imu' for root_node (known: waist), found \"hip\"");
  ImuStream unturned = node("hip");
  unturned.content.orientation = false;
  unturned.samples.orientation.clear();
  CHECK(fault(recording(unturned), manifest) ==
        "expected orientations in 'imu', for root_node, found none");
}

TEST_CASE("only points are brought onto another stream, and that one stays where it is") {
  Manifest manifest;
  manifest.spaces["imu"] = by("fit");
  CHECK(fault(of({recorded("optical", hundred()), recorded("imu", node("waist"))}), manifest) ==
        "expected a stream with joints in [space] (known: optical), found \"imu\"");
  manifest.spaces = {{"mocap", by("fit")}};
  CHECK(fault(of({recorded("optical", hundred()), recorded("mocap", skeleton())}), manifest) ==
        "expected points to be moved onto another stream, found 'mocap'");
  manifest.spaces = {{"optical", by("fit")}};
  CHECK(fault(two(hundred(), hundred()), manifest) ==
        "expected points to be moved onto another stream, found 'optical'");
  SpaceOptions onto_nothing = by("fit");
  onto_nothing.onto = "vicon";
  CHECK(fault_of_space(onto_nothing) ==
        "expected a stream with joints in [space] (known: optical, kinect), found \"vicon\"");
  manifest.spaces = {{"kinect", by("fit")}, {"second", by("fit")}};
  manifest.spaces["second"].onto = "kinect";
  CHECK(fault(of({recorded("optical", hundred()), recorded("kinect", hundred()),
                  recorded("second", hundred())}),
              manifest) ==
        "expected 'second' onto a stream that is not moved itself, found 'kinect'");
}

TEST_CASE("joints that a manifest names are there on both sides") {
  SpaceOptions space = by("fit");
  space.joints = {{"Nose", "Head"}};
  CHECK(
      fault_of_space(space) ==
      "expected a joint of 'kinect' (known: SpineBase, Head, HandLeft, HandRight), found \"Nose\"");
  space.joints = {{"Head", "Nose"}};
  CHECK(fault_of_space(space) ==
        "expected a joint of 'optical' (known: SpineBase, Head, HandLeft, HandRight), found "
        "\"Nose\"");
  CHECK(fault_of_space(by("paper")) ==
        "expected a joint of 'optical' (known: SpineBase, Head, HandLeft, HandRight), found "
        "\"Hips\"");
  space = by("paper");
  space.root = "Pelvis";
  CHECK(fault_of_space(space) ==
        "expected a joint of 'kinect' (known: SpineBase, Head, HandLeft, HandRight), found "
        "\"Pelvis\"");
  space.joints = {{"Head", "Head"}, {"HandLeft", "Head"}, {"HandRight", "HandRight"}};
  CHECK(fault_of_space(space) == "expected different joints of 'optical', found 'Head' twice");
}

TEST_CASE("a fit needs three named joints, and three places that stand on no line") {
  SpaceOptions space = by("fit");
  space.joints = {{"Head", "Head"}, {"HandLeft", "HandLeft"}};
  CHECK(
      fault_of_space(space) ==
      "expected at least three pairs of joints for a fit (joints = { ... }), found 2 (HandLeft on "
      "HandLeft, Head on Head)");
  const auto on_a_line = [](std::size_t j, double) {
    return Vec3(static_cast<double>(j), 2.0, -static_cast<double>(j));
  };
  CHECK(fault_of_space(by("fit"), points(joints, every(10 * ms, 100), on_a_line)) ==
        "kinect: expected points that are not on one line, found a line");
  auto never_seen = hundred();
  never_seen.frames.state.assign(never_seen.frames.state.size(), Tracking::inferred);
  CHECK(fault_of_space(by("fit"), never_seen) ==
        "kinect: expected rows for a fit, with tracked joints of both streams, found no "
        "such row (check rate_hz and gap_ms)");
}

TEST_CASE("a given rotation is one") {
  SpaceOptions space = by("given");
  space.rotation = {0.1, 0.0, 0.0, 0.0};
  CHECK(fault_of_space(space) ==
        "expected a unit quaternion w,x,y,z as rotation, found another length");
}

TEST_CASE("a reference that is shorter when it is read again is an error, never a shorter take") {
  const PointFrames shorter = points(joints, every(10 * ms, 90), wander).frames;
  const auto reference = read_in_blocks(recorded("optical", hundred()), shorter, 40);
  CHECK(fault(of({reference, recorded("kinect", hundred())})) ==
        "optical: expected 100 frames, as in the first reading, found 90");
}

TEST_CASE("a refusal that a verb gives advice on has a kind") {
  const auto kind = [](const Recording& recording, const Manifest& manifest) {
    const auto take = align(recording, manifest);
    REQUIRE_FALSE(take);
    return take.error().kind;
  };
  const auto kind_of_space = [&kind](const SpaceOptions& space) {
    Manifest manifest;
    manifest.spaces["kinect"] = space;
    return kind(two(hundred(), hundred()), manifest);
  };
  auto late = recorded("imu", node("waist"));
  late.clock.pieces.front().offset = Duration{5000 * ms};
  CHECK(kind(of({recorded("optical", hundred()), late}), {}) == ErrorKind::no_common_span);
  CHECK(kind(two(points(joints, every(1000 * ms, 2), wander),
                 points(joints, every(10 * ms, 21, 400 * ms), wander)),
             {}) == ErrorKind::no_common_span);
  Manifest manifest;
  manifest.streams = {told("imu")};
  manifest.streams[0].root_node = "hip";
  CHECK(kind(of({recorded("optical", hundred()), recorded("imu", node("waist"))}), manifest) ==
        ErrorKind::no_such_node);
  SpaceOptions space = by("fit");
  space.joints = {{"Nose", "Head"}};
  CHECK(kind_of_space(space) == ErrorKind::no_such_joint);
  space.joints = {{"Head", "Head"}, {"HandLeft", "HandLeft"}};
  CHECK(kind_of_space(space) == ErrorKind::too_few_joints);
  space.onto = "vicon";
  CHECK(kind_of_space(space) == ErrorKind::other);
}
