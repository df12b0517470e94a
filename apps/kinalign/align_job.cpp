// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/align_job.h"

#include "kinalign/align/align.h"
#include "kinalign/io/take_hdf5.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace kinalign {

namespace {

std::string duration_text(double s) {
  if (s < 60.0) return fmt::format("{:.2f} s", s);
  const auto whole = static_cast<std::int64_t>(s);
  return whole < 3600
             ? fmt::format("{} min {:02} s", whole / 60, whole % 60)
             : fmt::format("{} h {:02} min {:02} s", whole / 3600, whole / 60 % 60, whole % 60);
}

/// 3601: "3,601".
std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), 1, ',');
  }
  return text;
}

std::string name_of(const StreamReport& s) {
  return s.node.empty() ? s.stream : s.stream + " (" + s.node + ")";
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

std::string stream_names(const AlignmentReport& report) {
  std::string text;
  std::string last;
  for (const StreamReport& s : report.streams) {
    if (s.stream != last) text += (text.empty() ? "" : " + ") + s.stream;
    last = s.stream;
  }
  return text;
}

std::string time_line(const StreamReport& s) {
  const double interval = 1e-6 * static_cast<double>(s.worst_interval_ns.value_or(0));
  const std::string sure = !s.worst_interval_ns ? "stamps of unknown accuracy"
                           : interval == 0.0    ? "shared clock"
                                                : fmt::format("± {:.1f} ms", interval);
  return fmt::format("  time   {}: {}, {:.4g} Hz, nearest sample within {:.1f} ms\n", name_of(s),
                     sure, s.rate_hz, 1e-6 * static_cast<double>(s.worst_nearest_ns));
}

std::string space_lines(const SpaceReport& s) {
  const Eigen::AngleAxisd turn(s.transform.rotation);
  std::string how = "root onto root in every frame";
  if (s.method == "fit") how = "fitted once per take";
  if (s.method == "given") how = "as given";
  std::string text = fmt::format(
      "  space  {} on {} {:.1f} cm rms (before: {:.1f}), rotation {:.1f}°, {}\n", s.stream, s.onto,
      100.0 * s.after_m, 100.0 * s.before_m, turn.angle() * 180.0 / std::numbers::pi, how);
  if (s.joints.empty()) return text;
  text += "         worst";
  for (std::size_t k = 0; k < std::min<std::size_t>(3, s.joints.size()); ++k) {
    text += fmt::format("{} {} {:.1f} cm", k == 0 ? "" : ",", s.joints[k].joint,
                        100.0 * s.joints[k].after_m);
  }
  return text + "\n";
}

std::string gap_line(const StreamReport& s) {
  if (s.gaps == 0 && s.invalid == 0 && s.inferred == 0 && s.bridged == 0) return "";
  std::string text = "  gaps   " + name_of(s) + ":";
  if (s.gaps > 0) {
    text +=
        fmt::format(" {} ({:.2f} s, marked),", s.gaps, 1e-9 * static_cast<double>(s.gap_time_ns));
  }
  text += fmt::format(" {:.1f} % of samples invalid", share(s.invalid, s.samples));
  if (s.inferred > 0) text += fmt::format(", {:.1f} % inferred", share(s.inferred, s.samples));
  if (s.bridged > 0) {
    text += fmt::format(", {:.1f} % interpolated over loss", share(s.bridged, s.samples));
  }
  return text + "\n";
}

}  // namespace

Result<AlignmentReport> align_to_file(FileSystem& files, const Recording& recording,
                                      const Manifest& manifest, const std::string& out,
                                      Overwrite overwrite, const Progress& progress) {
  std::optional<TakeWriter> writer;
  TakeSink sink;
  sink.begin = [&](const TakeHeader& header) -> Result<void> {
    if (!out.empty()) writer.emplace(KA_TRY(TakeWriter::create(files, out, overwrite, header)));
    return {};
  };
  sink.rows = [&](const TakeSlab& slab) -> Result<void> {
    return writer ? writer->append(slab) : Result<void>{};
  };
  AlignmentReport report = KA_TRY(align(recording, manifest, sink, progress));
  if (writer) KA_TRY(writer->finish(report));
  return report;
}

std::string summary(const AlignmentReport& report, const std::string& out) {
  const double length =
      report.rate_hz > 0.0 ? static_cast<double>(report.frames) / report.rate_hz : 0.0;
  std::string text = fmt::format("{}: {}, {} frames at {:.4g} Hz, {}\n",
                                 out.empty() ? "nothing written" : out, duration_text(length),
                                 grouped(report.frames), report.rate_hz, stream_names(report));
  auto streams = report.streams;
  std::stable_sort(streams.begin(), streams.end(), [](const auto& a, const auto& b) {
    return a.worst_interval_ns.value_or(INT64_MAX) > b.worst_interval_ns.value_or(INT64_MAX);
  });
  for (const StreamReport& s : streams) {
    if (s.stream != report.reference) text += time_line(s);
  }
  for (const SpaceReport& s : report.spaces) text += space_lines(s);
  std::stable_sort(streams.begin(), streams.end(), [](const auto& a, const auto& b) {
    return share(a.invalid, a.samples) > share(b.invalid, b.samples);
  });
  for (const StreamReport& s : streams) text += gap_line(s);
  for (const Finding& finding : report.findings) {
    text += fmt::format("  {}  {}: {}\n", to_string(finding.severity), to_string(finding.what),
                        finding.meaning);
  }
  if (!out.empty()) text += fmt::format("  see    kinalign info {}\n", out);
  return text;
}

}  // namespace kinalign
