// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/verdict.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

/// If a figure is above `usable`, the stream is at most usable. Above `bad` it is bad.
struct Limits {
  double usable = 0.0, bad = 0.0;
};
// The limits of docs/report.md. Shares are shares of all samples.
constexpr Limits invalid_share{0.05, 0.5};
constexpr Limits inferred_share{0.10, 0.5};
constexpr Limits bridged_share{0.10, 0.5};
// The mean length of gaps is compared, because the report has only the sum.
constexpr Limits longest_gap_s{1.0, 10.0};
constexpr Limits interval_s{0.010, 0.1};
constexpr Limits residual_m{0.10, 0.30};
// A finding has no figure. The weight of a warning equals the limit of usable; the weight of an
// error is far above.
constexpr double finding_weight = 1.0, error_weight = 10.0;

Quality quality_of(double figure, const Limits& limits) {
  if (figure > limits.bad) return Quality::bad;
  return figure > limits.usable ? Quality::usable : Quality::good;
}

/// The weight is the figure divided by its limit, so that different kinds of concerns can be
/// compared.
Concern concern(const StreamReport& s, std::string what, double figure, const Limits& limits) {
  std::string part = fmt::format("{}", fmt::join(s.nodes, ", "));
  return {s.stream, std::move(part), std::move(what), figure / limits.usable,
          quality_of(figure, limits)};
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Returns a share as text: "2.2 %", or "less than 0.1 %" if it would be printed as 0.0.
std::string percent(double part) {
  return part < 0.0005 ? "less than 0.1 %" : fmt::format("{:.1f} %", 100.0 * part);
}

/// Adds a concern about a share of samples. A share of 0 is no concern.
void add_share(const StreamReport& s, std::uint64_t part, std::string_view what,
               const Limits& limits, std::vector<Concern>& out) {
  const double figure = share(part, s.samples);
  if (part == 0) return;
  out.push_back(concern(s, fmt::format("{} of samples {}", percent(figure), what), figure, limits));
}

void add_gaps(const StreamReport& s, std::vector<Concern>& out) {
  if (s.gaps == 0) return;
  const double time = 1e-9 * static_cast<double>(s.gap_time_ns);
  out.push_back(
      concern(s, fmt::format("{} gap{}, {:.2f} s in all", s.gaps, s.gaps == 1 ? "" : "s", time),
              time / static_cast<double>(s.gaps), longest_gap_s));
}

/// Adds a concern about the accuracy of the stream's stamps.
void add_time(const StreamReport& s, std::vector<Concern>& out) {
  // Unknown accuracy is just above the limit, so it makes a stream usable, never bad.
  if (!s.worst_interval_ns) {
    out.push_back(concern(s, "stamps of unknown accuracy", 1.01, {1.0, 2.0}));
    return;
  }
  const double interval = 1e-9 * static_cast<double>(*s.worst_interval_ns);
  if (interval > 0.0) {
    out.push_back(concern(s, fmt::format("stamps certain to {:.1f} ms", 1e3 * interval), interval,
                          interval_s));
  }
  if (s.unsure > 0) {
    out.push_back(concern(s,
                          percent(share(s.unsure, s.samples)) + " of samples at an uncertain time",
                          1.0 + share(s.unsure, s.samples), {1.0, 1.5}));
  }
}

void add_stream(const StreamReport& s, bool reference, std::vector<Concern>& out) {
  add_share(s, s.invalid, "invalid", invalid_share, out);
  add_share(s, s.inferred, "inferred", inferred_share, out);
  add_share(s, s.bridged, "interpolated over loss", bridged_share, out);
  add_gaps(s, out);
  // The take's time is the reference's time, so the reference has no time error.
  if (!reference) add_time(s, out);
}

/// Adds a concern about the residual of a moved stream. The joints are sorted by residual, so the
/// first joint is the worst.
void add_space(const SpaceReport& space, std::vector<Concern>& out) {
  Concern whole{space.stream, "", "", space.after_m / residual_m.usable,
                quality_of(space.after_m, residual_m)};
  whole.what = fmt::format("{:.1f} cm rms from {}", 100.0 * space.after_m, space.onto);
  if (!space.joints.empty()) {
    const JointResidual& worst = space.joints.front();
    whole.part = worst.joint;
    whole.what += fmt::format(", worst joint {} {:.1f} cm", worst.joint, 100.0 * worst.after_m);
  }
  out.push_back(std::move(whole));
}

/// Returns whether a finding concerns the stream: it names the stream, or it names one of its files
/// and no other stream.
bool is_about(const Finding& finding, const AlignmentReport& report, const std::string& stream,
              const std::vector<InputFacts>& files) {
  const auto names = [&finding](const std::string& name) {
    const std::string quoted = "'" + name + "'";
    return finding.what.expected.find(quoted) != std::string::npos ||
           finding.what.found.find(quoted) != std::string::npos;
  };
  if (names(stream) || finding.what.file == stream) return true;
  const bool of_another = std::any_of(
      // If several streams share a file, findings name the stream in quotes (with_stream_name in
      // judge.cpp).
      report.streams.begin(), report.streams.end(),
      [&](const StreamReport& other) { return other.stream != stream && names(other.stream); });
  if (of_another) return false;
  return std::any_of(files.begin(), files.end(),
                     [&finding](const InputFacts& file) { return file.name == finding.what.file; });
}

/// Adds an error or a warning as a concern. Notes are ignored.
void add_finding(const Finding& finding, const std::string& stream, std::vector<Concern>& out) {
  const bool error = finding.severity == Severity::error;
  if (finding.severity == Severity::note) return;
  const Error& error_of = finding.what;
  std::string what = to_string(error_of);
  if (!finding.meaning.empty()) {
    what = fmt::format("{} (expected {}, found {})", finding.meaning, error_of.expected,
                       error_of.found);
  }
  out.push_back({stream, "", std::move(what), error ? error_weight : finding_weight,
                 error ? Quality::bad : Quality::usable});
}

/// Compares by quality first, then by weight.
bool heavier(const Concern& a, const Concern& b) {
  if (a.quality != b.quality) return a.quality > b.quality;
  return a.weight > b.weight;
}

/// Sorts the concerns; the worst one gives the verdict. Concerns of equal weight keep their order.
void settle(Verdict& verdict) {
  std::stable_sort(verdict.concerns.begin(), verdict.concerns.end(), heavier);
  verdict.quality = verdict.concerns.front().quality;
  verdict.reason = words_of(verdict.concerns.front());
}

}  // namespace

std::string words_of(const Concern& concern) {
  const bool named = concern.part.empty() || concern.what.find(concern.part) != std::string::npos;
  return named ? concern.what : concern.part + ": " + concern.what;
}

std::string_view to_string(Quality quality) {
  switch (quality) {
    case Quality::good:
      return "good";
    case Quality::usable:
      return "usable";
    case Quality::bad:
      return "bad";
  }
  return "";
}

Verdict verdict_of(const AlignmentReport& report, const std::string& stream,
                   const std::vector<InputFacts>& files) {
  Verdict verdict;
  verdict.stream = stream;
  for (const StreamReport& s : report.streams) {
    if (s.stream == stream) add_stream(s, stream == report.reference, verdict.concerns);
  }
  for (const SpaceReport& space : report.spaces) {
    if (space.stream == stream) add_space(space, verdict.concerns);
  }
  for (const Finding& finding : report.findings) {
    if (is_about(finding, report, stream, files)) add_finding(finding, stream, verdict.concerns);
  }
  if (verdict.concerns.empty()) {
    verdict.reason = stream == report.reference ? "the reference, complete" : "complete";
  } else {
    settle(verdict);
  }
  return verdict;
}

void add_concern(Concern concern, Verdict& verdict) {
  verdict.concerns.push_back(std::move(concern));
  settle(verdict);
}

std::vector<Concern> worst_of(const std::vector<Verdict>& verdicts, std::size_t most) {
  std::vector<Concern> all;
  for (const Verdict& verdict : verdicts) {
    for (const Concern& c : verdict.concerns) {
      if (c.weight > 0.0) all.push_back(c);
    }
  }
  std::stable_sort(all.begin(), all.end(), heavier);
  std::vector<Concern> out;
  for (Concern& c : all) {
    // Several nodes with the same fault, for example because of one radio, count as one concern.
    const bool known = std::any_of(out.begin(), out.end(), [&c](const Concern& other) {
      const auto kind = [](const std::string& what) { return what.substr(what.find(' ') + 1); };
      return other.stream == c.stream && kind(other.what) == kind(c.what);
    });
    if (known) continue;
    if (out.size() == most) break;
    out.push_back(std::move(c));
  }
  return out;
}

}  // namespace kinalign
