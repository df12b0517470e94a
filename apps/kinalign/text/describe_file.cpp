// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/describe_file.h"

#include "apps/cli/console.h"
#include "apps/cli/json_text.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/text/describe_report.h"

#include "kinalign/align/judge.h"
#include "kinalign/align/plan.h"
#include "kinalign/documents/report_json.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/formats/take/take_hdf5.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <variant>

namespace kinalign {

Error blame(const std::string& path) { return {path, 0, "a take that HDF5 can read", ""}; }

namespace {

using Json = nlohmann::ordered_json;

/// The content of a stream in words, with the names of its joints or nodes.
struct Contents {
  std::string kind, parts;  // "points", "25 joints"
  Json names;
};

/// The contents of a stream of a recording (Kind: ClipInput, PointInput, ImuInput) or of a group in
/// a take (ClipGroup, PointGroup, ImuGroup).
template <class Kind>
Contents contents_of(const Kind& kind) {
  if constexpr (requires { kind.skeleton; }) {
    return {"clip",
            counted(kind.skeleton.joints(), "joint") + ", " +
                counted(kind.skeleton.end_sites.size(), "end site"),
            kind.skeleton.joint_names};
  } else if constexpr (requires { kind.joint_names; }) {
    return {"points", counted(kind.joint_names.size(), "joint"), kind.joint_names};
  } else {
    // Only quantities that the sensors measured are listed.
    std::vector<std::string> parts;
    if (kind.content.orientation) parts.emplace_back("orientation");
    if (kind.content.acceleration) {
      parts.emplace_back("acceleration with" + std::string(kind.content.gravity ? "" : "out") +
                         " gravity");
      // If the take has a root node, gravity was removed from all accelerations but the root's.
      if constexpr (requires { kind.root_node; }) {
        if (kind.content.gravity && !kind.root_node.empty()) {
          parts.back() += " in " + kind.root_node + " only";
        }
      }
    }
    if (kind.content.angular_velocity) parts.emplace_back("angular velocity");
    return {"imu",
            fmt::format("{}: {}", counted(kind.node_names.size(), "node"), fmt::join(parts, ", ")),
            kind.node_names};
  }
}

template <class... Kinds>
Contents contents_of(const std::variant<Kinds...>& any) {
  return std::visit([](const auto& kind) { return contents_of(kind); }, any);
}

Json files_json(const std::vector<InputFacts>& files) {
  Json out = Json::array();
  for (const InputFacts& file : files) {
    out.push_back({{"name", file.name}, {"sha256", file.sha256}, {"bytes", file.bytes}});
  }
  return out;
}

// A file with a fixed time between frames (a BVH) states its rate. For other files the rate follows
// from the median time between samples, which gaps do not change.
double rate_hz(const RecordedStream& s) {
  const double step = s.step_ns.value_or(static_cast<double>(s.survey.median_step_ns));
  return step > 0.0 ? 1e9 / step : 0.0;
}

double seconds_of(const StampSurvey& survey) {
  return 1e-9 * static_cast<double>((survey.last - survey.first).count());
}

/// The text " (25 on the whole)" if the mean rate differs from the usual rate by 10 % or more.
/// Bursts or gaps cause such a difference.
std::string mean_rate_text(const RecordedStream& s) {
  const double length = seconds_of(s.survey), rate = rate_hz(s);
  // The condition is also false if the length is NaN.
  if (!(length > 0.0)) return "";
  // kept() counts the samples whose stamps rise. There are n - 1 intervals between n samples.
  const double mean = static_cast<double>(s.survey.kept() - 1) / length;
  return std::abs(mean - rate) < 0.1 * rate ? ""
                                            : fmt::format(" ({:.4g} over the whole stream)", mean);
}

/// The lines about a stream: number of samples, rate, first and last stamp, names, and the number
/// of stamps that do not rise.
std::string stream_lines(const RecordedStream& s, const Contents& c, Names names) {
  // A file with one node is called by the node's name; the word "imu" is left out.
  const bool one_node = c.kind == "imu" && c.names.size() == 1;
  const std::string who = one_node ? shown(c.names.front().get<std::string>()) : c.kind;
  std::string line = fmt::format("  {:<8} {} ({}): {} samples over {:.3f} s at {:.4g} Hz{}; {}\n",
                                 s.name, who, shown(s.format), s.survey.samples,
                                 seconds_of(s.survey), rate_hz(s), mean_rate_text(s), c.parts);
  if (s.survey.kept() > 0) {
    line += fmt::format("           from {} to {} ns{}\n", to_ns(first_of(s)), to_ns(last_of(s)),
                        s.counted ? ", counted at that rate" : "");
  }
  // The names of nodes are few and important, so they are listed even without --verbose.
  if (names == Names::yes || (c.kind == "imu" && !one_node)) {
    line += name_lines(c.names.get<std::vector<std::string>>());
  }
  // Alignment can't use samples whose stamps do not rise.
  if (s.survey.kept() < s.survey.samples) {
    line += fmt::format("           {} stamps repeat, {} step back, {} jump ahead\n",
                        s.survey.duplicates, s.survey.backward, s.survey.ahead);
  }
  return line;
}

/// The JSON about a stream. Programs of users may depend on each of the keys.
Json stream_json(const RecordedStream& s, const Contents& c, const Findings& findings) {
  return {{"name", s.name},
          {"kind", c.kind},
          {"format", s.format},
          {"names", c.names},
          {"stamps_counted", s.counted},
          {"samples", s.survey.samples},
          {"first_ns", to_ns(first_of(s))},
          {"last_ns", to_ns(last_of(s))},
          {"rate_hz", rate_hz(s)},
          {"duplicate_stamps", s.survey.duplicates},
          {"backward_stamps", s.survey.backward},
          {"ahead_stamps", s.survey.ahead},
          {"files", files_json(s.files)},
          {"findings", Json::parse(findings_json(findings))}};
}

/// Everything about a take as one JSON text. The function runs in a child process.
Result<std::string> take_facts(FileSystem& files, const std::string& path) {
  // HDF5 may crash at a damaged file, so only this child process uses it. The parent process gets
  // text.
  const TakeReader reader = KA_TRY(TakeReader::open(files, path));
  const TakeHeader& header = reader.header();
  Json out{{"file", path},
           {"kind", "take"},
           {"software", reader.software()},
           {"subject", header.subject},
           {"action", header.action},
           {"frames", header.frames},
           {"streams", Json::array()}};
  for (const TakeGroup& group : header.groups) {
    const Contents c = contents_of(group.kind);
    out["streams"].push_back({{"name", group.name},
                              {"kind", c.kind},
                              {"parts", c.parts},
                              {"names", c.names},
                              {"files", files_json(group.files)}});
  }
  // The take contains the report as JSON text. That text may be damaged even if HDF5 could read it.
  out["report"] = Json::parse(KA_TRY(reader.report_json()), nullptr, false);
  if (out["report"].is_discarded()) {
    return Failure(Error{path, 0, "a report as JSON", "text that is not JSON"});
  }
  return json_text(out);
}

}  // namespace

std::string fact_line(std::string_view name, const std::string& value) {
  return fmt::format("  {:<12}{}\n", name, value);
}

std::string size_line(std::uint64_t bytes) {
  return fact_line("size", fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6));
}

std::string findings_line(std::size_t count, const std::string& path) {
  return count == 0 ? ""
                    : fmt::format("  {}: see kinalign check {}\n", counted(count, "finding"), path);
}

std::string contents_line(const RecordedStream& stream) {
  const Contents c = contents_of(stream.data);
  return (c.kind == "imu" ? "nodes, " : c.kind + ", ") + c.parts;
}

std::string read_as(const RecordedStream& stream) {
  return fmt::format("{}: read as {}, {} samples", stream.files.front().name, contents_line(stream),
                     stream.survey.samples);
}

/// Describes every stream of a recording. If several streams come from one file, the file's
/// findings are listed once.
Description describe_recording(const std::string& path, const Recording& recording, Names names) {
  Json out{{"file", path},
           {"kind", "recording"},
           {"subject", recording.subject},
           {"action", recording.action},
           {"streams", Json::array()}};
  std::string text = path + "\n";
  std::size_t findings = 0;
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    const RecordedStream& s = recording.streams[i];
    const Contents c = contents_of(s.data);
    // The findings of a file are listed with the file's first stream, so each finding is counted
    // once.
    const SharedFile* file = newly_read_file(recording, i);
    Findings found = file == nullptr ? Findings{} : file->findings;
    append(found, all_findings(s));
    out["streams"].push_back(stream_json(s, c, found));
    text += stream_lines(s, c, names);
    findings += found.size();
  }
  return {text + findings_line(findings, path), json_text(out)};
}

Result<Description> describe_take(FileSystem& files, const std::string& path, Names names) {
  const std::string json =
      KA_TRY(run_guarded(GuardLimits{}, blame(path), [&] { return take_facts(files, path); }));
  return Description{take_text(json, names), json};
}

// stable_sort keeps findings of the same severity in the order of the file.
std::string finding_lines(Findings findings, const Console& console) {
  std::stable_sort(findings.begin(), findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  std::string text;
  for (const Finding& finding : findings) {
    // 8 columns hold the longest word, "warning".
    const std::string word = fmt::format("{:<8}", to_string(finding.severity));
    text += console.paint(colour_of(finding.severity), word) + " ";
    text += harmless(to_string(finding.what) + "\n         " + finding.meaning + "\n");
    if (!finding.repair.empty()) text += harmless("         " + finding.repair + "\n");
  }
  return text;
}

}  // namespace kinalign
