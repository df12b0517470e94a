// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/truth_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* truth_schema = "kinalign.truth/1";

// ---- conversion to JSON

Json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json json_of(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }
Json json_of(const TrueClock& clock) {
  return {{"stamps_ns", clock.stamps_ns}, {"times_ns", clock.times_ns}};
}

Json json_of(const TrueMocap& mocap) {
  return {{"stream", mocap.stream},
          {"rate_hz", mocap.rate_hz},
          {"frames", mocap.frames},
          {"start_click_ns", mocap.start_click_ns},
          {"stop_click_ns", mocap.stop_click_ns},
          {"first_frame_ns", mocap.first_frame_ns}};
}

Json json_of(const TrueKinect& kinect) {
  return {{"stream", kinect.stream},
          {"rotation", json_of(kinect.world_from_kinect.rotation)},
          {"translation", json_of(kinect.world_from_kinect.translation)},
          {"drift_ppm", kinect.drift_ppm},
          {"clock", json_of(kinect.clock)}};
}

/// Converts a node with all its errors.
Json json_of(const TrueNode& node) {
  return {{"stream", node.stream},
          {"node", node.node},
          {"id", node.id},
          {"joint", node.joint},
          {"offset", json_of(node.offset)},
          {"bone_from_sensor", json_of(node.bone_from_sensor)},
          {"sensor_delay_ms", node.sensor_delay_ms},
          {"gyroscope_zero", json_of(node.gyroscope_zero)},
          {"accelerometer_zero", json_of(node.accelerometer_zero)},
          {"clock", json_of(node.clock)}};
}

// ---- from JSON: a member that is missing or of another type throws, and read_truth() reports the
// place

Vec3 vec3_from(const Json& json) {
  const auto v = json.get<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}
Quat quat_from(const Json& json) {
  const auto q = json.get<std::array<double, 4>>();
  // The text contains rounded numbers, so the quaternion is normalised.
  return Quat(q[0], q[1], q[2], q[3]).normalized();
}

/// Reads an integer that fits the type. get() would convert 1e30 without an error.
template <class Integer>
Integer integer_from(const Json& json) {
  const bool fits =
      json.is_number_unsigned()
          ? std::in_range<Integer>(json.get<std::uint64_t>())
          : json.is_number_integer() && std::in_range<Integer>(json.get<std::int64_t>());
  if (!fits)
    throw Json::other_error::create(
        501, std::string("an integer in range expected, found another ") + json.type_name(), &json);
  return json.get<Integer>();
}
std::vector<std::int64_t> integers_from(const Json& json) {
  std::vector<std::int64_t> integers;
  // get_ref() throws an exception if the value is not a list.
  for (const Json& one : json.get_ref<const Json::array_t&>()) {
    integers.push_back(integer_from<std::int64_t>(one));
  }
  return integers;
}
TrueClock clock_from(const Json& json) {
  return {integers_from(json.at("stamps_ns")), integers_from(json.at("times_ns"))};
}

TrueMocap mocap_from(const Json& json) {
  const auto ns = [&](const char* key) { return integer_from<std::int64_t>(json.at(key)); };
  // Each member is converted to the type of its field; otherwise an exception is thrown.
  return {json.at("stream"),    json.at("rate_hz"),  integer_from<std::uint64_t>(json.at("frames")),
          ns("start_click_ns"), ns("stop_click_ns"), ns("first_frame_ns")};
}

TrueKinect kinect_from(const Json& json) {
  return {json.at("stream"),
          {quat_from(json.at("rotation")), vec3_from(json.at("translation"))},
          json.at("drift_ppm"),
          clock_from(json.at("clock"))};
}

/// Reads a node. A missing member throws an exception.
TrueNode node_from(const Json& json) {
  return {json.at("stream"),
          json.at("node"),
          json.at("joint"),
          integer_from<std::uint32_t>(json.at("id")),
          vec3_from(json.at("offset")),
          quat_from(json.at("bone_from_sensor")),
          json.at("sensor_delay_ms"),
          vec3_from(json.at("gyroscope_zero")),
          vec3_from(json.at("accelerometer_zero")),
          clock_from(json.at("clock"))};
}

/// Reads the whole truth. A missing member throws an exception.
TrueRecording truth_from(const Json& json) {
  TrueRecording truth;
  truth.seed = integer_from<std::uint64_t>(json.at("seed"));
  truth.motion = json.at("motion");
  truth.motion_file = json.at("motion_file");
  truth.length_s = json.at("length_s");
  truth.start_ns = integer_from<std::int64_t>(json.at("start_ns"));
  truth.link = json.at("link");
  // Only simulations that were sent live have a host.
  if (json.contains("host")) {
    truth.host = TrueHost{integer_from<std::int64_t>(json.at("host").at("raw_ns")),
                          integer_from<std::int64_t>(json.at("host").at("utc_ns"))};
  }
  truth.mocap = mocap_from(json.at("mocap"));
  truth.kinect = kinect_from(json.at("kinect"));
  for (const Json& node : json.at("nodes")) truth.nodes.push_back(node_from(node));
  return truth;
}

/// Returns the message without its prefix in brackets, such as "[json.exception.out_of_range.403]".
std::string reason(const Json::exception& fault) {
  const std::string_view what = fault.what();
  const std::size_t end = what.find("] ");
  return shown(end == std::string_view::npos ? what : what.substr(end + 2));
}

// ---- checks beyond types

// Returns whether the values rise strictly.
bool rises(const std::vector<std::int64_t>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

bool within_limits(const std::vector<std::int64_t>& values) {
  return std::all_of(values.begin(), values.end(), [](std::int64_t value) {
    return -most_true_ns <= value && value <= most_true_ns;
  });
}

Result<void> check(const std::string& name, const std::string& stream, const TrueClock& clock) {
  if (!within_limits(clock.stamps_ns) || !within_limits(clock.times_ns)) {
    return refuse(name, "stamps and times of " + stream + " within 2e18 ns", "others");
  }
  // The true times need not rise: if samples are stamped on arrival, the times may go back
  // (docs/formats/truth.md).
  if (clock.stamps_ns.size() == clock.times_ns.size() && rises(clock.stamps_ns)) return {};
  return refuse(name, "a clock of " + stream + " with a time for each of rising stamps", "another");
}

}  // namespace

std::string truth_json(const TrueRecording& truth) {
  // The JSON has one line without spaces, because the clocks have many entries.
  Json json{{"schema", truth_schema},     {"seed", truth.seed},
            {"motion", truth.motion},     {"motion_file", truth.motion_file},
            {"length_s", truth.length_s}, {"start_ns", truth.start_ns},
            {"link", truth.link}};
  if (truth.host) {
    json["host"] = Json{{"raw_ns", truth.host->raw_ns}, {"utc_ns", truth.host->utc_ns}};
  }
  json["mocap"] = json_of(truth.mocap);
  json["kinect"] = json_of(truth.kinect);
  json["nodes"] = Json::array();
  for (const TrueNode& node : truth.nodes) json["nodes"].push_back(json_of(node));
  return json.dump() + "\n";
}

Result<TrueRecording> read_truth(std::string_view text, const std::string& name) {
  TrueRecording truth;
  try {
    const Json json = Json::parse(text);
    const std::string found = json.at("schema");
    if (found != truth_schema) return refuse(name, truth_schema, shown(found));
    truth = truth_from(json);
  } catch (const Json::exception& fault) {
    return refuse(name, std::string("JSON as ") + truth_schema + " has it", reason(fault));
  }
  KA_TRY(check(name, truth.kinect.stream, truth.kinect.clock));
  for (const TrueNode& node : truth.nodes) KA_TRY(check(name, node.node, node.clock));
  const TrueMocap& mocap = truth.mocap;
  if (!(mocap.rate_hz >= 1.0 && mocap.rate_hz <= 1e6) || mocap.frames > 1'000'000'000 ||
      !within_limits({mocap.first_frame_ns, truth.start_ns})) {
    return refuse(name, "a mocap of 1 Hz to 1 MHz, 1e9 frames at the most", "another");
  }
  return truth;
}

}  // namespace kinalign
