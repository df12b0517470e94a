// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/report_json.h"

#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// The facts about a stream's stamps.
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

/// The facts about a stream. Members of unknown value are left out.
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

/// The transform of a stream, with the residuals of its joints.
Json space_json(const SpaceReport& space) {
  // Eigen stores x,y,z,w. The text has w,x,y,z.
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

/// Names may contain bytes that are not UTF-8; they become U+FFFD.
std::string written(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

/// The whole report as JSON.
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

}  // namespace kinalign
