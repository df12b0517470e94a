// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/take_summary.h"

#include "kinalign/core/find_named.h"
#include "kinalign/core/hash.h"
#include "kinalign/documents/parameters_json.h"
#include "kinalign/documents/report_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view schema = "kinalign.take_summary/1";

/// The summary of a group without the counts of its samples.
struct StreamOf {
  StreamSummary operator()(const ClipGroup& group) const {
    return stream(Modality::mocap, group.skeleton.joints());
  }
  StreamSummary operator()(const PointGroup& group) const {
    return stream(Modality::kinect, group.joint_names.size());
  }
  StreamSummary operator()(const ImuGroup& group) const {
    StreamSummary out = stream(Modality::imu, group.node_names.size());
    out.nodes = group.node_names;
    return out;
  }
  static StreamSummary stream(Modality modality, std::size_t columns) {
    StreamSummary out;
    out.modality = modality;
    out.columns = columns;
    return out;
  }
};

/// Sums over the reports of a group. In a group of nodes each node has its own report.
struct Sums {
  std::uint64_t samples = 0, invalid = 0, inferred = 0;
};

/// Adds a stream's report to its group.
void add_report(const StreamReport& report, StreamSummary& stream, Sums& sums) {
  sums.samples += report.samples;
  sums.invalid += report.invalid;
  sums.inferred += report.inferred;
  stream.gaps += report.gaps;
  stream.gap_s += 1e-9 * static_cast<double>(report.gap_time_ns);
  if (report.worst_interval_ns) {
    stream.interval_ns = std::max(stream.interval_ns.value_or(0), *report.worst_interval_ns);
  }
}

/// Adds the reports of all streams to their groups, then converts counts to shares.
void add_streams(const AlignmentReport& report, TakeSummary& out) {
  std::map<std::string, Sums> sums;
  for (const StreamReport& one : report.streams) {
    StreamSummary* const stream = find_named(out.streams, one.stream);
    if (stream != nullptr) add_report(one, *stream, sums[one.stream]);
  }
  for (StreamSummary& stream : out.streams) {
    const Sums& of = sums[stream.name];
    // Without samples the defaults stay: all samples are valid, none is inferred.
    if (of.samples == 0) continue;  // the reference, which is not resampled
    const auto all = static_cast<double>(of.samples);
    stream.valid = 1.0 - static_cast<double>(of.invalid) / all;
    stream.inferred = static_cast<double>(of.inferred) / all;
  }
}

/// Counts findings, also those that do not concern a stream.
void add_findings(const AlignmentReport& report, TakeSummary& out) {
  for (const Finding& finding : report.findings) {
    if (finding.severity == Severity::note) continue;
    const bool error = finding.severity == Severity::error;
    (error ? out.errors : out.warnings) += 1;
    // A finding that does not concern a stream is in no stream's verdict, so it counts here.
    const Quality least = error ? Quality::bad : Quality::usable;
    if (out.quality >= least) continue;
    out.quality = least;
    out.worst = to_string(finding.what);
  }
}

/// The verdict of a take is that of its worst stream.
void add_verdicts(const TakeHeader& header, const AlignmentReport& report, TakeSummary& out) {
  for (const TakeGroup& group : header.groups) {
    const Verdict verdict = verdict_of(report, group.name, group.files);
    if (verdict.quality <= out.quality) continue;
    out.quality = verdict.quality;
    out.worst = group.name + ": " + verdict.reason;
  }
}

/// The JSON of a stream's summary.
Json stream_json(const StreamSummary& stream) {
  Json out = {{"name", stream.name},
              {"modality", modality_names[static_cast<std::size_t>(stream.modality)]},
              {"columns", stream.columns},
              {"valid", stream.valid},
              {"inferred", stream.inferred},
              {"gaps", stream.gaps},
              {"gap_s", stream.gap_s}};
  if (stream.interval_ns) out["interval_ns"] = *stream.interval_ns;
  if (!stream.nodes.empty()) out["nodes"] = stream.nodes;
  return out;
}

/// A stream's summary from JSON; a missing member throws.
StreamSummary stream_from(const Json& json) {
  StreamSummary out;
  out.name = json.at("name").get<std::string>();
  const auto modality = json.at("modality").get<std::string>();
  const auto* const found = std::find(modality_names.begin(), modality_names.end(), modality);
  // A modality with an unknown name counts as mocap.
  out.modality =
      static_cast<Modality>(found == modality_names.end() ? 0 : found - modality_names.begin());
  out.columns = json.at("columns").get<std::uint64_t>();
  out.valid = json.at("valid").get<double>();
  out.inferred = json.at("inferred").get<double>();
  out.gaps = json.at("gaps").get<std::uint64_t>();
  out.gap_s = json.at("gap_s").get<double>();
  if (json.contains("interval_ns")) out.interval_ns = json["interval_ns"].get<std::int64_t>();
  if (json.contains("nodes")) out.nodes = json["nodes"].get<std::vector<std::string>>();
  return out;
}

/// A summary from JSON; a missing member throws.
TakeSummary summary_from(const Json& json) {
  TakeSummary out;
  out.subject = json.at("subject").get<std::string>();
  out.action = json.at("action").get<std::string>();
  out.frames = json.at("frames").get<std::uint64_t>();
  out.rate_hz = json.at("rate_hz").get<double>();
  out.begin_ns = json.at("begin_ns").get<std::int64_t>();
  out.end_ns = json.at("end_ns").get<std::int64_t>();
  if (json.contains("residual_m")) out.residual_m = json["residual_m"].get<double>();
  const auto verdict = json.at("verdict").get<std::string>();
  // If the word is unknown, the quality stays good.
  for (const Quality quality : {Quality::usable, Quality::bad}) {
    if (verdict == to_string(quality)) out.quality = quality;
  }
  out.errors = json.at("errors").get<std::uint64_t>();
  out.warnings = json.at("warnings").get<std::uint64_t>();
  out.worst = json.at("worst").get<std::string>();
  out.software = json.at("software").get<std::string>();
  out.recipe = json.at("recipe").get<std::string>();
  out.sha256 = json.at("sha256").get<std::string>();
  out.bytes = json.at("bytes").get<std::uint64_t>();
  for (const Json& stream : json.at("streams")) out.streams.push_back(stream_from(stream));
  for (const Json& input : json.at("inputs")) {
    out.inputs.push_back({input.at("name").get<std::string>(),
                          input.at("sha256").get<std::string>(),
                          input.at("bytes").get<std::uint64_t>()});
    // Older summaries do not state which inputs have samples, so all inputs count as having
    // samples.
    if (input.value("samples", true)) out.sample_files.insert(out.inputs.back().name);
  }
  return out;
}

}  // namespace

bool TakeSummary::has(Modality modality) const {
  return std::any_of(streams.begin(), streams.end(),
                     [modality](const StreamSummary& s) { return s.modality == modality; });
}

std::string recipe_of(const Manifest& manifest) {
  Sha256 hash;
  // The folder of the data set is removed from the paths, because it must not change the recipe.
  hash.update(parameters_json(without_folders(manifest)));
  return hash.hex();
}

Result<TakeSummary> summary_of(const TakeHeader& header, std::string_view report_json) {
  TakeSummary out;
  out.subject = header.subject;
  out.action = header.action;
  out.frames = header.frames;
  out.recipe = recipe_of(header.parameters);
  const AlignmentReport report = KA_TRY(parse_report_json(report_json, ""));
  // If the report belongs to another take, all of its figures would be wrong.
  if (report.frames != header.frames) {
    return Failure(Error{"", 0, std::to_string(header.frames) + " frames in the take's report",
                         std::to_string(report.frames)});
  }
  out.rate_hz = report.rate_hz;
  out.begin_ns = to_ns(report.begin);
  out.end_ns = to_ns(report.end);
  for (const TakeGroup& group : header.groups) {
    StreamSummary stream = std::visit(StreamOf{}, group.kind);
    stream.name = group.name;
    // The reference counts as mocap, even if it is a stream of points.
    if (group.name == report.reference) stream.modality = Modality::mocap;
    out.streams.push_back(std::move(stream));
    for (const InputFacts& input : group.files) {
      // The groups of one recording have the same input files, which are listed once.
      if (std::find(out.inputs.begin(), out.inputs.end(), input) == out.inputs.end()) {
        out.inputs.push_back(input);
      }
    }
  }
  // Inputs get the names that they have in the take, even if it was built from other paths.
  const Manifest remembered = without_folders(header.parameters);
  for (const StreamOptions& stream : remembered.streams) {
    for (const StreamFile& file : stream.files) out.sample_files.insert(file.path);
  }
  // The verdicts come before the findings, because findings can only make the quality worse.
  add_streams(report, out);
  add_verdicts(header, report, out);
  add_findings(report, out);
  for (const SpaceReport& space : report.spaces) {
    // The worst of all moved streams counts.
    out.residual_m = std::max(out.residual_m.value_or(0.0), space.after_m);
  }
  return out;
}

/// Writes the summary; parse_summary_json() reads it.
std::string summary_json(const TakeSummary& s) {
  Json out = {{"schema", schema},        {"subject", s.subject},   {"action", s.action},
              {"frames", s.frames},      {"rate_hz", s.rate_hz},   {"begin_ns", s.begin_ns},
              {"end_ns", s.end_ns},      {"verdict", s.verdict()}, {"errors", s.errors},
              {"warnings", s.warnings},  {"worst", s.worst},       {"streams", Json::array()},
              {"inputs", Json::array()}, {"software", s.software}, {"recipe", s.recipe},
              {"sha256", s.sha256},      {"bytes", s.bytes}};
  if (s.residual_m) out["residual_m"] = *s.residual_m;
  for (const StreamSummary& stream : s.streams) out["streams"].push_back(stream_json(stream));
  for (const InputFacts& input : s.inputs) {
    out["inputs"].push_back({{"name", input.name},
                             {"sha256", input.sha256},
                             {"bytes", input.bytes},
                             {"samples", s.sample_files.contains(input.name)}});
  }
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<TakeSummary> parse_summary_json(std::string_view json, const std::string& file) {
  try {
    // The JSON library throws exceptions, which are converted to errors here.
    const Json parsed = Json::parse(json);
    if (parsed.at("schema").get<std::string>() != schema) {
      return Failure(Error{file, 0, "the schema " + std::string(schema),
                           shown(parsed["schema"].get<std::string>())});
    }
    return summary_from(parsed);
  } catch (const Json::exception& fault) {
    return Failure(
        Error{file, 0, "a summary of a take (" + std::string(schema) + ")", shown(fault.what())});
  }
}

}  // namespace kinalign
