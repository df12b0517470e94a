// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/describe_report.h"

#include "apps/cli/help.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/text/summary.h"

#include "kinalign/core/error.h"
#include "kinalign/documents/json_values.h"
#include "kinalign/documents/report_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <numbers>
#include <optional>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// Reads a stamp in ns. Returns 0 if the member is missing or above 9.2e18; with this limit sums
/// and dates of stamps fit into int64.
std::int64_t stamp_at(const Json& json, const char* key) {
  return whole_at(json, key, 9'200'000'000'000'000'000);
}

/// The begin and the end of a take. The stamps of devices without a calendar count from near zero,
/// so no date is printed for them.
std::string span_text(const Json& report) {
  // A begin near zero is no date. kinalign writes no report whose end is before its begin.
  const std::int64_t begin = stamp_at(report, "begin_ns"), end = stamp_at(report, "end_ns");
  if (!is_date(begin) || end < begin) {
    return fmt::format("  from {:.3f} to {:.3f} s, no date known\n",
                       1e-9 * static_cast<double>(begin), 1e-9 * static_cast<double>(end));
  }
  return fmt::format("  from {} to {} UTC\n", date_text(begin), date_text(end));
}

/// The first lines about a take: software, frames, rate, length, subject and action.
std::string head_text(const Json& take, const Json& report) {
  const double rate = number_at(report, "rate_hz");
  // The functions number_at(), count_at() and text_at() return an empty value if a member has a
  // wrong type.
  const std::uint64_t frames = count_at(take, "frames");
  std::string text = fmt::format("{}: a take by {}, {} frames", text_at(take, "file"),
                                 text_at(take, "software"), grouped(frames));
  if (rate > 0.0) {
    text += fmt::format(" at {:.4g} Hz, {}", rate,
                        duration_text(take_seconds(stamp_at(report, "begin_ns"),
                                                   stamp_at(report, "end_ns"), rate)));
  }
  text += "\n";
  const std::string subject = text_at(take, "subject"), action = text_at(take, "action");
  if (!subject.empty() || !action.empty()) {
    text += subject.empty() ? "" : "  subject " + subject;
    text += action.empty() ? "" : (subject.empty() ? "  action " : ", action ") + action;
    text += "\n";
  }
  return text + span_text(report);
}

/// The text ", 97.8 % valid, 1.6 % inferred". Empty for a skeleton that was not resampled.
std::string marks_text(const Json& s) {
  const std::uint64_t samples = count_at(s, "samples");
  // The report has no number of samples for a stream that was not resampled.
  if (samples == 0) return "";
  // A damaged report may state more invalid samples than there are samples.
  const std::uint64_t invalid = std::min(samples, count_at(s, "invalid"));
  const std::string valid = share_text(samples - invalid, samples);
  std::string text = valid.empty() ? ", nothing valid" : ", " + valid + " valid";
  const auto share = [&](const char* key, const char* what) {
    if (count_at(s, key) > 0) text += ", " + share_text(count_at(s, key), samples) + what;
  };
  share("inferred", " inferred");
  share("bridged", " interpolated over loss");
  share("unsure", " of unknown time");
  return text;
}

/// The quality of a stream: "29.92 Hz, shared clock, 97.8 % valid, 2 gaps (0.83 s)".
std::string quality_text(const Json& s) {
  const auto has = [&s](const char* key) { return s.is_object() && s.contains(key); };
  std::optional<std::int64_t> interval_ns;
  // A missing interval means that the clock's error is not known; an interval of zero means no
  // error.
  if (has("worst_interval_ns")) interval_ns = stamp_at(s, "worst_interval_ns");
  const bool stamps_counted = has("stamps_counted") && s["stamps_counted"] == true;
  std::string text = fmt::format("{:.4g} Hz, ", number_at(s, "rate_hz"));
  text += clock_text(interval_ns, stamps_counted);
  if (count_at(s, "late") > 0) {
    text += fmt::format(", {} samples late by {:.2f} s or more", grouped(count_at(s, "late")),
                        1e-9 * number_at(s, "worst_late_ns"));
  }
  text += marks_text(s);
  const std::uint64_t gaps = count_at(s, "gaps");
  // The total length of the gaps is shown, too, since one long gap is worse than many short ones.
  if (gaps > 0) {
    text +=
        fmt::format(", {} ({:.2f} s)", counted(gaps, "gap"), 1e-9 * number_at(s, "gap_time_ns"));
  }
  return text + fmt::format(", nearest sample within {:.1f} ms\n",
                            1e-6 * number_at(s, "worst_nearest_ns"));
}

std::vector<std::string> texts_at(const Json& json, const char* key) {
  std::vector<std::string> out;
  for (const Json& one : list_at(json, key)) {
    if (one.is_string()) out.push_back(one.get<std::string>());
  }
  return out;
}

/// The lines about a stream of a take: its files, and the quality of each of its devices or nodes.
std::string stream_text(const Json& stream, const Json& report, Names names) {
  const std::string name = text_at(stream, "name");
  std::string text =
      fmt::format("  {:<8} {}: {}\n", name, text_at(stream, "kind"), text_at(stream, "parts"));
  if (names == Names::yes) text += name_lines(texts_at(stream, "names"));
  for (const Json& file : list_at(stream, "files")) {
    // The first twelve digits of a hash are enough to compare two files by eye.
    text += fmt::format("           {}  sha256 {}...\n", text_at(file, "name"),
                        text_at(file, "sha256").substr(0, 12));
  }
  // The reference stream gives the times of the take's frames. It was not resampled, so it has no
  // interval.
  const bool reference = name == text_at(report, "reference");
  for (const Json& s : list_at(report, "streams")) {
    // The report has one entry for each device or file of a stream of nodes. Each entry gets its
    // own line.
    if (text_at(s, "stream") != name) continue;
    if (reference) return text + "           the reference" + marks_text(s) + "\n";
    const std::string nodes = fmt::format("{}", fmt::join(texts_at(s, "nodes"), ", "));
    text += "           " + (nodes.empty() ? "" : nodes + ": ") + quality_text(s);
  }
  return text;
}

/// The lines about a stream that was moved into the coordinates of another stream, with the
/// remaining distance of each joint.
std::string space_text(const Json& space) {
  // Both numbers are distances between the same joints: before the move and after it.
  std::string text =
      fmt::format("  space    {} on {}, {}: {:.1f} cm rms (before: {:.1f})\n",
                  text_at(space, "stream"), text_at(space, "onto"), text_at(space, "method"),
                  100.0 * number_at(space, "after_m"), 100.0 * number_at(space, "before_m"));
  for (const Json& joint : list_at(space, "joints")) {
    text += fmt::format("           {:<16} on {:<16} {:6.1f} cm over {} rows\n",
                        text_at(joint, "joint"), text_at(joint, "onto"),
                        100.0 * number_at(joint, "after_m"), grouped(count_at(joint, "rows")));
  }
  return text;
}

/// A mark with its time since the take's first frame. A mark before the first frame has a negative
/// time.
std::string mark_text(const Json& mark, std::int64_t begin_ns) {
  const double at_s =
      // Stamps of a damaged report may be anything, so the difference is computed in double.
      1e-9 * (static_cast<double>(stamp_at(mark, "time_ns")) - static_cast<double>(begin_ns));
  return fmt::format("  mark     {}\n", mark_words(text_at(mark, "kind"), text_at(mark, "text"),
                                                   at_s, text_at(mark, "source")));
}

std::string finding_text(const Json& finding) {
  // The text is made by Error, so that it has the same form as the text of other findings.
  const Error what{text_at(finding, "file"), static_cast<std::int64_t>(count_at(finding, "line")),
                   text_at(finding, "expected"), text_at(finding, "found")};
  return fmt::format("  {:<8} {}: {}\n", text_at(finding, "severity"), to_string(what),
                     text_at(finding, "meaning"));
}

}  // namespace

std::string mark_words(std::string_view kind, std::string_view text, double at_s,
                       std::string_view source) {
  return fmt::format("{}{} at {:.3f} s, by {}", kind, text.empty() ? "" : " " + shown(text), at_s,
                     source);
}

std::string name_lines(const std::vector<std::string>& names) {
  // All lines below a stream are indented by eleven columns.
  constexpr std::size_t indent = 11, width = 80;
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + shown(name);
  return text.empty() ? "" : std::string(indent, ' ') + wrapped(text, indent, width) + "\n";
}

Result<Findings> report_findings(const std::string& report, const std::string& path) {
  return KA_TRY(parse_report_json(report, path)).findings;
}

std::string take_text(const std::string& json, Names names) {
  const Json take = Json::parse(json, nullptr, false);
  // `report` is a reference, so the empty object needs a name.
  const Json none = Json::object();
  const Json& report = take.is_object() && take.contains("report") ? take["report"] : none;
  std::string text = head_text(take, report);
  // Streams come first, then spaces, marks and findings.
  for (const Json& stream : list_at(take, "streams")) text += stream_text(stream, report, names);
  for (const Json& space : list_at(report, "spaces")) text += space_text(space);
  for (const Json& mark : list_at(report, "marks")) {
    text += mark_text(mark, stamp_at(report, "begin_ns"));
  }
  for (const Json& finding : list_at(report, "findings")) text += finding_text(finding);
  return text;
}

}  // namespace kinalign
