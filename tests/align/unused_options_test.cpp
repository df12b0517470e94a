// SPDX-License-Identifier: Apache-2.0
// Every option of a manifest is used, or the manifest is refused.
#include "kinalign/align/unused_options.h"

#include "tests/align/two_streams.h"

#include <doctest/doctest.h>

#include <functional>

using namespace kinalign;
using namespace kinalign::test;

namespace {

using SayOfStream = std::function<void(StreamOptions&)>;
using SayOfSpace = std::function<void(SpaceOptions&)>;

const SayOfStream rate = [](StreamOptions& o) { o.rate_hz = 30.0; };
const SayOfStream end = [](StreamOptions& o) { o.end_ns = 9'000'000'000; };
const SayOfStream latency = [](StreamOptions& o) { o.click_latency_ms = 400.0; };
const SayOfStream unit = [](StreamOptions& o) { o.metres_per_unit = 0.01; };
const SayOfStream root = [](StreamOptions& o) { o.root_node = "waist"; };

Clip skeleton() {
  Clip clip;
  clip.skeleton = {{"Hips"}, {-1}, {Vec3::Zero()}, {}};
  return clip;
}

/// The error for a stream named "some" whose options are set by `say`.
std::string fault(RecordedStream stream, const SayOfStream& say) {
  stream.name = "some";
  Manifest manifest;
  manifest.streams.resize(1);
  manifest.streams[0].name = "some";
  say(manifest.streams[0]);
  const auto used = check_options_used({"", "", {std::move(stream)}}, manifest);
  return used ? "" : to_string(used.error());
}

std::string of_clip(const SayOfStream& say) { return fault(recorded("", skeleton()), say); }
std::string of_points(const SayOfStream& say) { return fault(recorded("", PointStream{}), say); }
std::string of_nodes(const SayOfStream& say) { return fault(recorded("", ImuStream{}), say); }

std::string of_space(const std::string& method, const SayOfSpace& say) {
  Manifest manifest;
  SpaceOptions& space = manifest.spaces["kinect"];
  space.method = method;
  say(space);
  const auto used = check_options_used({}, manifest);
  return used ? "" : to_string(used.error());
}

}  // namespace

TEST_CASE(
    "of a skeleton's file clicks, unit and axis can be said, a rate can't: it states its step") {
  for (const auto& say : {end, latency, unit}) CHECK(of_clip(say).empty());
  CHECK(of_clip(rate) == "expected for 'some' only options of a skeleton, found rate_hz");
  CHECK(of_clip(root) == "expected for 'some' only options of a skeleton, found root_node");
}

TEST_CASE("options that a recording states itself are refused: start, clock, drift, interval") {
  const auto recording = [](RecordedStream stream) {
    stream.format = "recording";
    return stream;
  };
  const SayOfStream start = [](StreamOptions& o) { o.start_ns = 5; };
  const SayOfStream shared = [](StreamOptions& o) { o.clock = "shared"; };
  const SayOfStream drift = [](StreamOptions& o) { o.drift_ppm = 1.0; };
  const SayOfStream interval = [](StreamOptions& o) { o.interval_ms = 1.0; };
  const SayOfStream delay = [](StreamOptions& o) { o.offset_ms = -30.0; };
  for (const auto& stream : {recorded("", skeleton()), recorded("", PointStream{})}) {
    for (const auto& say : {start, end, latency, shared, drift, interval, root}) {
      CHECK(!fault(recording(stream), say).empty());
    }
    CHECK(fault(recording(stream), delay).empty());
  }
  CHECK(!fault(recording(recorded("", ImuStream{})), drift).empty());
  CHECK(fault(recording(recorded("", ImuStream{})), root).empty());
  CHECK(fault(recording(recorded("", skeleton())), rate).empty());  // the stream states no rate
}

TEST_CASE("an interval is of another clock than the reference's, and of one that leaves doubt") {
  Manifest manifest;
  manifest.streams.resize(2);
  manifest.streams[0].name = "optical";
  manifest.streams[1].name = "kinect";
  const Recording recording = {
      "", "", {recorded("optical", PointStream{}), recorded("kinect", PointStream{})}};
  const auto fault_of = [&](const std::string& reference) {
    manifest.align.reference = reference;
    const auto used = check_options_used(recording, manifest);
    return used ? "" : to_string(used.error());
  };
  manifest.streams[1].interval_ms = 4.0;
  CHECK(fault_of("").empty());
  CHECK(fault_of("kinect") ==
        "expected interval_ms only for streams other than the reference, found interval_ms for "
        "'kinect', the reference");
  manifest.streams[1].clock = "shared";
  CHECK(fault_of("") ==
        "expected either a shared clock or an interval_ms for 'kinect', found both: with clock = "
        "\"shared\" the interval is 0");
  manifest.streams[1].interval_ms.reset();
  manifest.streams[0].clock = "shared";  // the reference's clock is shared in any case
  CHECK(fault_of("").empty());
}

TEST_CASE("points accept a rate and a unit, but no clicks") {
  for (const auto& say : {rate, unit}) CHECK(of_points(say).empty());
  CHECK(of_points(end) == "expected for 'some' only options of points, found end_ns");
  CHECK(of_points(latency) == "expected for 'some' only options of points, found click_latency_ms");
  CHECK(of_points(root) == "expected for 'some' only options of points, found root_node");
}

TEST_CASE("mountings are of nodes, and a refusal names the file") {
  const SayOfStream worn = [](StreamOptions& o) { o.mounting["waist"] = {1, 0, 0, 0}; };
  CHECK(of_nodes(worn).empty());
  CHECK(of_points(worn) == "expected for 'some' only options of points, found mounting");
  RecordedStream clip = recorded("", skeleton());
  clip.files = {{"walk.bvh", "", 0}};
  CHECK(fault(clip, worn) ==
        "expected for 'some' (walk.bvh) only options of a skeleton, found mounting");
}

TEST_CASE("nodes accept a rate and a root, but no clicks and no unit") {
  for (const auto& say : {rate, root}) CHECK(of_nodes(say).empty());
  CHECK(of_nodes(end) == "expected for 'some' only options of nodes, found end_ns");
  CHECK(of_nodes(latency) == "expected for 'some' only options of nodes, found click_latency_ms");
  CHECK(of_nodes(unit) == "expected for 'some' only options of nodes, found metres_per_unit");
}

TEST_CASE("a space's method takes what it has a use for, and nothing else") {
  const std::vector<std::pair<std::string, SayOfSpace>> keys{
      {"onto", [](SpaceOptions& o) { o.onto = "mocap"; }},
      {"joints",
       [](SpaceOptions& o) {
         o.joints = {{"Head", "Head"}};
       }},
      {"rotation",
       [](SpaceOptions& o) {
         o.rotation = {1, 0, 0, 0};
       }},
      {"translation",
       [](SpaceOptions& o) {
         o.translation = {1, 0, 0};
       }},
      {"rotation_y_deg", [](SpaceOptions& o) { o.rotation_y_deg = 0.0; }},
      {"magnification", [](SpaceOptions& o) { o.magnification = 100.0; }},
      {"root", [](SpaceOptions& o) { o.root = "Head"; }},
      {"onto_root", [](SpaceOptions& o) { o.onto_root = "Head"; }}};
  const std::map<std::string, std::string> taken{
      {"none", "nothing"},
      {"fit", "onto, joints"},
      {"given", "onto, joints, rotation, translation"},
      {"paper", "onto, joints, rotation_y_deg, magnification, root, onto_root"}};
  for (const auto& [method, list] : taken) {
    for (const auto& [key, say] : keys) {
      CAPTURE(method);
      CAPTURE(key);
      const bool used = (", " + list + ",").find(", " + key + ",") != std::string::npos;
      const bool lacks = method == "given" && key != "rotation" && key != "translation";
      const std::string refusal = "expected in [space.kinect] only options of method = \"" +
                                  method + "\" (" + list + "), found " + key;
      const std::string lack =
          "expected rotation or translation in [space.kinect], whose method is \"given\", found "
          "neither";
      CHECK(of_space(method, say) == (!used ? refusal : lacks ? lack : ""));
    }
  }
}

TEST_CASE(
    "a key that a file says is refused where it has no effect, also with the default's value") {
  Manifest manifest;
  SpaceOptions& space = manifest.spaces["kinect"];
  space.method = "fit";
  space.lines = {{"method", 4}, {"onto", 5}, {"rotation_y_deg", 6}};
  const auto used = check_options_used({}, manifest);
  REQUIRE_FALSE(used);
  CHECK(used.error().line == 6);
  CHECK(used.error().found == "rotation_y_deg");
  space.lines.erase("rotation_y_deg");
  CHECK(check_options_used({}, manifest));
  manifest.streams.resize(1);
  manifest.streams[0].name = "some";
  manifest.streams[0].lines = {{"file", 2}, {"clock", 3}, {"root_node", 4}};
  const Recording recording{"", "", {recorded("some", PointStream{})}};
  const auto line = [&] {
    const auto checked = check_options_used(recording, manifest);
    return checked ? 0 : checked.error().line;
  };
  CHECK(line() == 4);
  manifest.streams[0].lines.erase("root_node");
  CHECK(line() == 3);  // the reference's clock has no doubt
  manifest.align.reference = "other";
  CHECK(line() == 0);
  manifest.streams[0].interval_ms = 4.0;
  CHECK(line() == 3);
  manifest.streams[0].lines.erase("clock");
  CHECK(line() == 0);
  manifest.streams[0].lines["mounting"] = 5;  // a mounting without a value
  CHECK(line() == 5);
}
