// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/report_json.h"

#include "kinalign/documents/json_values.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// Converts the facts about a stream's stamps to JSON.
Json survey_json(const StampSurvey& survey) {
  return {{"samples", survey.samples},
          {"duplicates", survey.duplicates},
          {"backward", survey.backward},
          {"ahead", survey.ahead},
          {"largest_step_back_ns", survey.largest_step_back_ns},
          {"first_ns", to_ns(survey.first)},
          {"last_ns", to_ns(survey.last)},
          {"median_step_ns", survey.median_step_ns},
          {"long_steps", survey.long_steps},
          {"long_time_ns", survey.long_time_ns}};
}

/// Converts the facts about a stream to JSON. Members with unknown values are omitted.
Json stream_json(const StreamReport& stream) {
  Json out = {{"stream", stream.stream}};
  if (!stream.nodes.empty()) out["nodes"] = stream.nodes;
  out["stamps"] = survey_json(stream.survey);
  out["stamps_counted"] = stream.counted;
  out["rate_hz"] = stream.rate_hz;
  out["gap_ns"] = stream.gap_ns;
  out["held_back"] = stream.held_back;
  out["near"] = stream.arrivals.near;
  out["late"] = stream.arrivals.late;
  out["worst_late_ns"] = stream.arrivals.worst_late_ns;
  out["gaps"] = stream.gaps;
  out["gap_time_ns"] = stream.gap_time_ns;
  out["samples"] = stream.samples;
  out["invalid"] = stream.invalid;
  out["empty_rows"] = stream.empty_rows;
  out["inferred"] = stream.inferred;
  out["bridged"] = stream.bridged;
  out["worst_nearest_ns"] = stream.worst_nearest_ns;
  if (stream.worst_interval_ns) out["worst_interval_ns"] = *stream.worst_interval_ns;
  if (stream.unsure > 0) out["unsure"] = stream.unsure;
  return out;
}

/// Converts the transform of a stream, with the residuals of its joints, to JSON.
Json space_json(const SpaceReport& space) {
  // Eigen stores x,y,z,w; the JSON contains w,x,y,z.
  const Quat& q = space.transform.rotation;
  const Vec3& t = space.transform.translation;
  Json out = {{"stream", space.stream},
              {"onto", space.onto},
              {"method", space.method},
              {"rotation", {q.w(), q.x(), q.y(), q.z()}},
              {"translation_m", {t.x(), t.y(), t.z()}},
              {"magnification", space.magnification},
              {"before_m", space.before_m},
              {"after_m", space.after_m},
              {"joints", Json::array()}};
  for (const JointResidual& joint : space.joints) {
    out["joints"].push_back({{"joint", joint.joint},
                             {"onto", joint.onto},
                             {"rows", joint.rows},
                             {"before_m", joint.before_m},
                             {"after_m", joint.after_m}});
  }
  return out;
}

Json mark_json(const TakeMark& mark) {
  Json out = {{"time_ns", to_ns(mark.at)}, {"kind", mark.kind}, {"source", mark.source}};
  if (!mark.text.empty()) out["text"] = mark.text;
  if (mark.latency) out["latency_ms"] = 1e3 * seconds(*mark.latency);
  return out;
}

Json finding_json(const Finding& finding) {
  return {{"severity", std::string(to_string(finding.severity))},
          {"file", finding.what.file},
          {"line", finding.what.line},
          {"expected", finding.what.expected},
          {"found", finding.what.found},
          {"meaning", finding.meaning},
          {"repair", finding.repair}};
}

Json findings_array(const Findings& findings) {
  Json out = Json::array();
  for (const Finding& finding : findings) out.push_back(finding_json(finding));
  return out;
}

/// Returns JSON as text. Bytes of names that are not UTF-8 become U+FFFD.
std::string written(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// ---- from JSON, which may come from another program: members of a wrong type are ignored, and
// control characters in texts become '?'

/// Reads a stamp or duration, ns. Returns 0 if it is missing or too large for a take.
std::int64_t ns_at(const Json& json, const char* key) {
  // The limit is about 126 years. The difference of two such numbers fits into 64 bits.
  return whole_at(json, key, 4'000'000'000'000'000'000);
}

template <std::size_t count>
std::array<double, count> numbers_at(const Json& json, const char* key) {
  // Missing numbers stay 0.
  std::array<double, count> out{};
  const Json& list = list_at(json, key);
  for (std::size_t i = 0; i < std::min(count, list.size()); ++i) {
    if (list[i].is_number()) out[i] = list[i].get<double>();
  }
  return out;
}

/// The counts are checked for consistency, because shares and differences are computed from them.
StampSurvey survey_from(const Json& json) {
  StampSurvey out;
  out.samples = count_at(json, "samples");
  out.duplicates = count_at(json, "duplicates");
  out.backward = count_at(json, "backward");
  out.ahead = count_at(json, "ahead");
  out.largest_step_back_ns = ns_at(json, "largest_step_back_ns");
  out.first = utc_time(ns_at(json, "first_ns"));
  out.last = utc_time(ns_at(json, "last_ns"));
  out.median_step_ns = ns_at(json, "median_step_ns");
  out.long_steps = count_at(json, "long_steps");
  out.long_time_ns = ns_at(json, "long_time_ns");
  if (out.duplicates > out.samples || out.backward > out.samples - out.duplicates ||
      out.ahead > out.samples - out.duplicates - out.backward) {
    out.duplicates = out.backward = out.ahead = 0;  // otherwise kept() would become negative
  }
  return out;
}

/// Reads a stream of the report. The invalid samples are limited to the number of samples, because
/// shares are computed from them.
StreamReport stream_from(const Json& json) {
  StreamReport out;
  out.stream = text_at(json, "stream");
  for (const Json& node : list_at(json, "nodes")) {
    if (node.is_string()) out.nodes.push_back(node.get<std::string>());
  }
  if (json.is_object() && json.contains("stamps")) out.survey = survey_from(json["stamps"]);
  out.counted =
      json.is_object() && json.contains("stamps_counted") && json["stamps_counted"] == true;
  out.rate_hz = number_at(json, "rate_hz");
  out.gap_ns = ns_at(json, "gap_ns");
  // A missing count is read as 0. Takes of older versions do not have these counts.
  out.held_back = count_at(json, "held_back");
  out.arrivals.near = count_at(json, "near");
  out.arrivals.late = count_at(json, "late");
  out.arrivals.worst_late_ns = ns_at(json, "worst_late_ns");
  out.gaps = count_at(json, "gaps");
  out.gap_time_ns = ns_at(json, "gap_time_ns");
  out.samples = count_at(json, "samples");
  out.invalid = std::min(out.samples, count_at(json, "invalid"));
  out.empty_rows = count_at(json, "empty_rows");
  out.inferred = count_at(json, "inferred");
  out.bridged = count_at(json, "bridged");
  out.worst_nearest_ns = ns_at(json, "worst_nearest_ns");
  if (json.is_object() && json.contains("worst_interval_ns")) {
    out.worst_interval_ns = ns_at(json, "worst_interval_ns");
  }
  out.unsure = count_at(json, "unsure");
  return out;
}

/// Reads a space of the report. A rotation that is not a unit quaternion is ignored.
SpaceReport space_from(const Json& json) {
  SpaceReport out;
  out.stream = text_at(json, "stream");
  out.onto = text_at(json, "onto");
  out.method = text_at(json, "method");
  const auto q = numbers_at<4>(json, "rotation");
  // A missing rotation consists of zeros, so the identity is kept.
  const Quat rotation(q[0], q[1], q[2], q[3]);
  if (rotation.norm() > 0.5 && rotation.norm() < 2.0) {
    out.transform.rotation = rotation.normalized();
  }
  const auto t = numbers_at<3>(json, "translation_m");
  out.transform.translation = Vec3(t[0], t[1], t[2]);
  // A magnification of 0 would put all points at one place.
  const double magnification = number_at(json, "magnification");
  if (magnification > 0.0) out.magnification = magnification;
  out.before_m = number_at(json, "before_m");
  out.after_m = number_at(json, "after_m");
  for (const Json& joint : list_at(json, "joints")) {
    out.joints.push_back({text_at(joint, "joint"), text_at(joint, "onto"), count_at(joint, "rows"),
                          number_at(joint, "before_m"), number_at(joint, "after_m")});
  }
  return out;
}

/// Reads a mark of the report.
TakeMark mark_from(const Json& json) {
  TakeMark out;
  out.at = utc_time(ns_at(json, "time_ns"));
  out.kind = text_at(json, "kind");
  out.text = text_at(json, "text");
  out.source = text_at(json, "source");
  if (json.is_object() && json.contains("latency_ms")) {
    // The limit prevents overflow of the product below.
    const double ms = std::clamp(number_at(json, "latency_ms"), -1e9, 1e9);
    out.latency = Duration{std::llround(1e6 * ms)};
  }
  return out;
}

/// Reads a finding. An unknown severity becomes a warning.
Finding finding_from(const Json& json) {
  const std::string severity = text_at(json, "severity");
  Finding out;
  if (severity == "note") out.severity = Severity::note;
  if (severity == "error") out.severity = Severity::error;
  out.what = {text_at(json, "file"), ns_at(json, "line"), text_at(json, "expected"),
              text_at(json, "found")};
  out.meaning = text_at(json, "meaning");
  out.repair = text_at(json, "repair");
  return out;
}

}  // namespace

/// Returns the whole report as JSON.
std::string report_json(const AlignmentReport& report) {
  Json out = {{"schema", "kinalign.report/1"},   {"frames", report.frames},
              {"begin_ns", to_ns(report.begin)}, {"end_ns", to_ns(report.end)},
              {"rate_hz", report.rate_hz},       {"reference", report.reference},
              {"streams", Json::array()},        {"spaces", Json::array()}};
  for (const StreamReport& stream : report.streams) out["streams"].push_back(stream_json(stream));
  for (const SpaceReport& space : report.spaces) out["spaces"].push_back(space_json(space));
  for (const TakeMark& mark : report.marks) out["marks"].push_back(mark_json(mark));
  out["findings"] = findings_array(report.findings);
  return written(out);
}

std::string findings_json(const Findings& findings) { return written(findings_array(findings)); }

Findings parse_findings_json(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  Findings out;
  // If the JSON is not a list, there are no findings.
  for (const Json& finding : json.is_array() ? json : Json::array()) {
    out.push_back(finding_from(finding));
  }
  return out;
}

Result<AlignmentReport> parse_report_json(std::string_view text, const std::string& path) {
  const Json json = Json::parse(text, nullptr, false);
  // Only text that is not JSON is an error. Other faults give a report with fewer members.
  if (json.is_discarded()) {
    return refuse(path, "a report as JSON", "text that is not JSON");
  }
  AlignmentReport out;
  out.frames = count_at(json, "frames");
  out.begin = utc_time(ns_at(json, "begin_ns"));
  out.end = utc_time(ns_at(json, "end_ns"));
  out.rate_hz = number_at(json, "rate_hz");
  out.reference = text_at(json, "reference");
  for (const Json& stream : list_at(json, "streams")) out.streams.push_back(stream_from(stream));
  for (const Json& space : list_at(json, "spaces")) out.spaces.push_back(space_from(space));
  for (const Json& mark : list_at(json, "marks")) out.marks.push_back(mark_from(mark));
  for (const Json& finding : list_at(json, "findings")) {
    out.findings.push_back(finding_from(finding));
  }
  return out;
}

}  // namespace kinalign
