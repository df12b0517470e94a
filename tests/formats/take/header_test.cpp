// SPDX-License-Identifier: Apache-2.0
// Allowed names of a take's streams, and their arrays, for every file format that holds takes.
#include "kinalign/formats/take/take_layout.h"

#include <doctest/doctest.h>

#include <array>

using namespace kinalign;

namespace {

TakeHeader of(std::vector<TakeGroup> groups) {
  TakeHeader header;
  header.groups = std::move(groups);
  return header;
}

TakeGroup points(const std::string& name, std::vector<std::string> joints = {"Head"}) {
  return {name, PointGroup{std::move(joints)}, true, true, {}, "take"};
}

std::string fault_of(const TakeHeader& header) {
  const auto done = validate(header);
  return done ? "none" : to_string(done.error());
}

/// "positions float32 [3,3] units m, space take"
std::string text_of(const TakeColumn& column) {
  constexpr std::array<const char*, 5> types{"float32", "float64", "int64", "int32", "uint8"};
  std::string out = column.name + " " + types.at(static_cast<std::size_t>(column.stored)) + " [";
  for (const std::uint64_t size : column.shape) {
    out += (out.back() == '[' ? "" : ",") + std::to_string(size);
  }
  out += "]";
  for (const auto& [name, value] : column.facts) {
    out += (out.back() == ']' ? " " : ", ") + name + " " + value;
  }
  return out;
}

std::vector<std::string> columns(const TakeGroup& group, Precision precision = Precision::single) {
  std::vector<std::string> out;
  for (const TakeColumn& column : columns_of(group, precision)) out.push_back(text_of(column));
  return out;
}

using Columns = std::vector<std::string>;

const Skeleton skeleton{{"Hips", "Spine"}, {-1, 0}, {Vec3::Zero(), Vec3::UnitY()}, {}};

}  // namespace

TEST_CASE("a stream's name can be a group next to the other contents of a take") {
  for (const std::string name :
       {"a/b", "time_ns", "seconds", "t0_ns", "report_json", "parameters_json", ".", ".."}) {
    CHECK(fault_of(of({points(name)})) ==
          "expected a stream's name that can be a group of the take, found \"" + name + "\"");
  }
  CHECK(fault_of(of({points("")})) ==
        "expected a stream's name that can be a group of the take, found an empty name");
  CHECK(fault_of(of({points("kinect"), points("kinect")})) ==
        "expected a name for each stream, only once, found \"kinect\"");
  CHECK(fault_of(of({points("kinect"), points("Kinect"), points("3 k#")})) == "none");
}

TEST_CASE("joints and nodes have names that differ, none empty, none with a NUL in it") {
  CHECK(fault_of(of({points("k", {"Head", "Head"})})) ==
        "expected a name for each joint, only once, found \"Head\"");
  CHECK(fault_of(of({points("k", {"Head", std::string("a\0b", 3)})}))
            .starts_with("expected a name for each joint, found \"a"));
  const TakeGroup nodes{"imu", ImuGroup{{"waist", "waist"}, {}, ""}, true, false, {}, "take"};
  CHECK(fault_of(of({nodes})) == "expected a name for each node, only once, found \"waist\"");
  Skeleton backward = skeleton;
  backward.parents = {1, -1};
  CHECK(fault_of(of({{"mocap", ClipGroup{backward}, false, false, {}, "take"}})) ==
        "expected each parent before its children, found joint 'Hips'");
}

TEST_CASE(
    "a skeleton's stream has places and turns, and what is valid only once it was resampled") {
  TakeGroup clip{"mocap", ClipGroup{skeleton}, false, false, {}, "take"};
  const std::string parents = "space each joint in its parent's, a root in the take's";
  const Columns own{"positions float32 [2,3] units m, space take",
                    "local_positions float32 [2,3] units m, " + parents,
                    "local_rotations float32 [2,4] order w,x,y,z, " + parents};
  CHECK(columns(clip) == own);
  clip.resampled = true;
  Columns resampled = own;
  resampled.insert(resampled.end(),
                   {"valid uint8 [] values 0 no, 1 yes", "nearest_raw_ns int64 [] units ns"});
  CHECK(columns(clip) == resampled);
  clip.space = "suit";
  CHECK(columns(clip)[0] == "positions float32 [2,3] units m, space suit");
  CHECK(columns(clip)[1] ==
        "local_positions float32 [2,3] units m, space each joint in its parent's, a root in suit's "
        "own");
}

TEST_CASE("points have places, states and what is valid, and how far their samples were") {
  CHECK(columns(points("k", {"Head", "Neck", "Hips"}), Precision::full) ==
        Columns{"positions float64 [3,3] units m, space take",
                "state uint8 [3] values 0 missing, 1 inferred, 2 tracked",
                "valid uint8 [3] values 0 no, 1 yes", "nearest_raw_ns int64 [] units ns",
                "time_interval_ns int64 [] units ns"});
}

TEST_CASE("nodes have the quantities that were measured, in the world's space or the root's") {
  ImuGroup imu{{"waist", "wrist"}, {true, true, true, true}, ""};
  TakeGroup group{"imu", imu, true, true, {}, "take"};
  CHECK(columns(group) ==
        Columns{"orientation float32 [2,4] order w,x,y,z, space world",
                "acceleration float32 [2,3] units m/s2, space each node's own, as mounted, "
                "gravity included",
                "angular_velocity float32 [2,3] units rad/s, space each node's own, as mounted",
                "valid uint8 [2] values 0 no, 1 yes", "nearest_raw_ns int64 [2] units ns",
                "time_interval_ns int64 [2] units ns"});
  imu.content = {false, true, false, false};
  imu.root_node = "waist";
  group.kind = imu;
  group.interval_known = false;
  CHECK(columns(group) ==
        Columns{"acceleration float32 [2,3] units m/s2, space waist, gravity removed",
                "valid uint8 [2] values 0 no, 1 yes", "nearest_raw_ns int64 [2] units ns"});
}

TEST_CASE(
    "in a root node's space only the root's acceleration contains gravity, as the file states") {
  const auto said = [](bool gravity, std::string root) {
    const ImuGroup imu{{"wrist", "waist"}, {true, true, true, gravity}, std::move(root)};
    Columns out = columns({"imu", imu, true, false, {}, "take"});
    out.resize(2);
    const std::vector<std::string> nodes = gravity_texts(imu);
    out.insert(out.end(), nodes.begin(), nodes.end());
    return out;
  };
  CHECK(
      said(true, "waist") ==
      Columns{"orientation float32 [2,4] order w,x,y,z, space waist; its own: world",
              "acceleration float32 [2,3] units m/s2, space waist, gravity included in waist only",
              "removed", "included"});
  CHECK(said(false, "waist")[1].ends_with("gravity removed"));
  CHECK(gravity_texts({{"wrist", "waist"}, {true, true, true, true}, ""}) ==
        Columns{"included", "included"});
  CHECK(gravity_texts({{"wrist", "waist"}, {true, true, true, false}, "waist"}) ==
        Columns{"removed", "removed"});
}

TEST_CASE("a row's bytes are its values' times their size") {
  const auto all = columns_of(points("k", {"a", "b"}), Precision::full);
  CHECK(all[0].row_values() == 6);
  CHECK(all[0].row_bytes() == 48);
  CHECK(all[1].row_bytes() == 2);
  CHECK(all[3].row_bytes() == 8);
}
