// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/page_json.h"

#include "kinalign/view/page/packed_series.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// Rounding steps of series in s, m, rad/s and m/s2. They are below the resolution of all devices.
constexpr double second_step = 1e-4, metre_step = 5e-4, rate_step = 0.01, acceleration_step = 0.02;
// Rounding steps in rad, and for components of a quaternion.
constexpr double angle_step = 2e-5, rotation_step = 1.0 / 2048.0;

/// Returns the word by which the script recognises the kind.
std::string_view name_of(PageKind kind) { return kind == PageKind::clip ? "clip" : "points"; }

/// Rounds a number, because fewer digits make a smaller page. JSON has only finite numbers; others
/// become 0.
double rounded(double x, double step) {
  const double y = std::round(x / step);
  return std::isfinite(y) ? y / std::round(1.0 / step) : 0.0;
}

Json vector_json(const Vec3& v) {
  return {rounded(v.x(), 1e-6), rounded(v.y(), 1e-6), rounded(v.z(), 1e-6)};
}

/// There are few bins, so they are written as plain numbers.
Json bins_json(const std::vector<float>& bins, double factor, double step) {
  Json out = Json::array();
  for (const float x : bins) out.push_back(rounded(factor * static_cast<double>(x), step));
  return out;
}

/// Converts a body with its packed positions and states. Positions are rounded to half a
/// millimetre.
Json body_json(const PageBody& body) {
  const std::size_t joints = body.joint_names.size();
  return {{"name", body.name},
          {"kind", name_of(body.kind)},
          {"colour", to_string(body.colour)},
          {"joint_names", body.joint_names},
          {"parents", body.parents},
          {"in_take_space", body.in_take_space},
          {"positions", series_json(body.positions, 3 * joints, metre_step)},
          {"state", series_json(body.state, joints)}};
}

/// Converts a space with its transform and residuals.
Json space_json(const PageSpace& space) {
  const Quat& q = space.report.transform.rotation;
  // The residuals of the report, which figure 6 shows.
  Json joints = Json::array();
  for (const JointResidual& joint : space.report.joints) {
    joints.push_back({{"joint", joint.joint},
                      {"onto", joint.onto},
                      {"rows", joint.rows},
                      {"before_m", rounded(joint.before_m, 1e-5)},
                      {"after_m", rounded(joint.after_m, 1e-5)}});
  }
  return {{"stream", space.report.stream},
          {"onto_stream", space.report.onto},
          {"method", space.report.method},
          {"body", space.body},
          {"onto", space.onto},
          {"pairs", space.pairs},
          {"once_per_take", space.once_per_take},
          {"rotation", {q.w(), q.x(), q.y(), q.z()}},
          {"translation", vector_json(space.report.transform.translation)},
          {"before_m", rounded(space.report.before_m, 1e-5)},
          {"after_m", rounded(space.report.after_m, 1e-5)},
          {"joints", std::move(joints)}};
}

/// Converts a floor. The limits of the zones are included, so that the script needs no constants.
Json floor_json(const PageFloor& floor) {
  return {{"body", floor.body},
          {"camera", vector_json(floor.camera)},
          {"forward", vector_json(floor.forward)},
          {"best", {best_near_m, best_far_m}},
          {"largest", {largest_near_m, largest_far_m}},
          {"field_deg", field_deg}};
}

Json bone_json(const BoneLength& bone) {
  return {{"body", bone.body},
          {"joint", bone.joint},
          {"rows", bone.rows},
          {"mean_m", rounded(bone.mean_m, 1e-5)},
          {"deviation_m", rounded(bone.deviation_m, 1e-5)},
          {"shortest_m", rounded(bone.shortest_m, 1e-5)},
          {"longest_m", rounded(bone.longest_m, 1e-5)}};
}

/// Converts a lane; distances and intervals only if the stream has them, in ms as in figure 3.
Json lane_json(const PageLane& lane) {
  Json out{{"stream", lane.stream},
           {"part", lane.part},
           {"colour", to_string(lane.colour)},
           {"resampled", lane.resampled},
           {"interval_known", lane.interval_known},
           {"tracked", bins_json(lane.tracked, 1.0, 1e-3)},
           {"inferred", bins_json(lane.inferred, 1.0, 1e-3)}};
  if (lane.resampled) out["nearest_raw_ms"] = bins_json(lane.nearest_raw_s, 1e3, 0.1);
  if (lane.interval_known) out["interval_ms"] = bins_json(lane.interval_s, 1e3, 0.01);
  return out;
}

/// Converts the signals that a node measures. Raw samples have their own times, since they are
/// between rows.
Json node_json(const NodeFigures& node) {
  Json out{{"node", node.node},
           {"joint", node.joint},
           {"gravity", node.has_gravity},
           {"valid", series_json(node.valid, 1)}};
  if (node.has_rate) {
    out["rate"] = series_json(node.rate, 3, rate_step);
    out["mocap_rate"] = series_json(node.mocap_rate, 3, rate_step);
  }
  if (node.has_acceleration) {
    out["acceleration"] = series_json(node.acceleration, 3, acceleration_step);
    out["mocap_acceleration"] = series_json(node.mocap_acceleration, 3, acceleration_step);
  }
  if (!node.raw_seconds.empty()) {
    out["raw_seconds"] = series_json(node.raw_seconds, 1, second_step);
    if (node.has_rate) out["raw_rate"] = series_json(node.raw_rate, 3, rate_step);
    if (node.has_acceleration) {
      out["raw_acceleration"] = series_json(node.raw_acceleration, 3, acceleration_step);
    }
  }
  // The error is for figure 13, the axes are for the player.
  if (node.has_orientation) {
    out["orientation_error"] = series_json(node.orientation_error, 1, angle_step);
    out["axes"] = series_json(node.axes, 4, rotation_step);
  }
  return out;
}

/// Converts a detail. Its rows are absent if the page stores every row.
Json detail_json(const TakePage& page, const PageDetail& detail) {
  const std::size_t joints = page.bodies[detail.body].joint_names.size();
  Json out{{"body", detail.body},
           {"begin_s", rounded(detail.begin_s, 1e-4)},
           {"end_s", rounded(detail.end_s, 1e-4)},
           {"near_seconds", series_json(detail.near_seconds, 1, second_step)},
           {"has_raw", detail.has_raw}};
  if (!detail.seconds.empty()) {
    // Each row contains the positions of all counterparts.
    const std::size_t pairs = detail.onto_positions.size() / detail.seconds.size() / 3;
    out["seconds"] = series_json(detail.seconds, 1, second_step);
    out["positions"] = series_json(detail.positions, 3 * joints, metre_step);
    out["state"] = series_json(detail.state, joints);
    out["onto_positions"] = series_json(detail.onto_positions, 3 * pairs, metre_step);
  }
  if (detail.has_raw) {
    out["raw_seconds"] = series_json(detail.raw_seconds, 1, second_step);
    out["raw_positions"] = series_json(detail.raw_positions, 3 * joints, metre_step);
    out["raw_state"] = series_json(detail.raw_state, joints);
  }
  return out;
}

/// Converts a list of the page to a list of JSON objects.
template <class Items, class ToJson>
Json list_json(const Items& items, ToJson to_json) {
  Json out = Json::array();
  for (const auto& item : items) out.push_back(to_json(item));
  return out;
}

}  // namespace

Json series_json(const std::vector<float>& values, std::size_t columns, double step) {
  return {{"rows", columns == 0 ? 0 : values.size() / columns},
          {"columns", columns},
          {"step", step},
          {"packed", packed_series(values, columns, step)}};
}

Json series_json(const std::vector<std::uint8_t>& values, std::size_t columns) {
  return {{"rows", columns == 0 ? 0 : values.size() / columns},
          {"columns", columns},
          {"step", 1},
          {"packed", packed_series(std::span(values), columns)}};
}

// "</script>" in a name would end the script element, and "<!--" would begin a comment.
std::string safe_in_script(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string_view to_string(PageColour colour) {
  if (colour == PageColour::mocap) return "mocap";
  return colour == PageColour::kinect ? "kinect" : "imu";
}

// All figures over time show the marks of the recording.
std::string page_json(const TakePage& page) {
  Json marks = Json::array();
  for (const TakeMark& mark : page.report.marks) {
    const double at = seconds(mark.at - page.report.begin);
    marks.push_back({{"seconds", rounded(at, 1e-3)}, {"kind", mark.kind}, {"text", mark.text}});
  }
  const Json out{{"file", page.file},
                 {"stride", page.stride},
                 {"rate_hz", page.report.rate_hz},
                 {"length_s", rounded(seconds(page.report.end - page.report.begin), 1e-4)},
                 {"seconds", series_json(page.seconds, 1, second_step)},
                 {"bodies", list_json(page.bodies, body_json)},
                 {"spaces", list_json(page.spaces, space_json)},
                 {"floors", list_json(page.floors, floor_json)},
                 {"bones", list_json(page.bones, bone_json)},
                 {"joint_states", list_json(page.joint_states,
                                            [](const JointStates& s) { return Json(s.counts); })},
                 {"lanes", list_json(page.lanes, lane_json)},
                 {"node_body", page.node_body},
                 {"nodes", list_json(page.nodes, node_json)},
                 {"details", list_json(page.details,
                                       [&](const PageDetail& d) { return detail_json(page, d); })},
                 {"marks", std::move(marks)}};
  return safe_in_script(out.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace kinalign
