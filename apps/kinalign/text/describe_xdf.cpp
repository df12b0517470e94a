// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/json_text.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// The rate that the sender stated and the rate of the stamps. Both are shown, because the stated
/// rate may be wrong.
std::string rate_text(const XdfStreamSurvey& one) {
  const double nominal = one.stream.nominal_rate_hz;
  std::string text = nominal > 0.0 ? fmt::format("{:.6g} Hz nominal", nominal) : "irregular";
  if (one.rate_hz() > 0.0) text += fmt::format(", {:.6g} Hz by the stamps", one.rate_hz());
  return text;
}

std::string stamps_text(const XdfStreamSurvey& one) {
  std::string text = fmt::format("{:.6f} to {:.6f} s, {:.1f} s of the sender's clock", *one.first,
                                 *one.last, *one.last - *one.first);
  // LSL leaves out stamps that follow from the rate. The reader computes them again.
  if (one.deduced > 0) text += fmt::format("; {} deduced by the rate", grouped(one.deduced));
  return text;
}

/// The clock of a stream's sender. LSL measures the offset between sender and recorder every few
/// seconds, and a straight line is fitted to these offsets. If the clock was reset, there are
/// several lines. The text states offset, drift and largest residual of the last line.
std::string stream_clock_text(const XdfStreamSurvey& one) {
  if (one.clock.empty()) return "no clock offsets";
  double residual = 0.0;
  for (const XdfClockLine& line : one.clock) residual = std::max(residual, line.largest_residual);
  const XdfClockLine& last = one.clock.back();
  std::string text = fmt::format("{}: {:+.6f} s, {:+.3f} ppm, residuals up to {:.3f} ms",
                                 counted(one.clock_offsets, "clock offset"), last.offset,
                                 1e6 * last.slope, 1e3 * residual);
  // Each reset of the clock begins a new line.
  if (one.clock.size() > 1) text += fmt::format("; restarted {} times", one.clock.size() - 1);
  return text;
}

/// The lines about a stream of an XDF file.
std::string stream_lines(const XdfStreamSurvey& one, Names names) {
  const XdfStream& s = one.stream;
  std::string text =
      fact_line("stream", fmt::format("{}{}: {} of {}, {} samples, {}", shown(s.name),
                                      s.type.empty() ? "" : " (" + shown(s.type) + ")",
                                      counted(s.channel_count, "channel"), name_of(s.format),
                                      grouped(one.samples), rate_text(one)));
  if (one.first) text += fact_line("  stamps", stamps_text(one));
  text += fact_line("  clock", stream_clock_text(one));
  // An EEG may have hundreds of channels, so they are listed only with --verbose.
  if (names == Names::no) return text;
  for (const XdfChannel& channel : s.channels) {
    const std::string unit = channel.unit.empty() ? "" : ", " + shown(channel.unit);
    text += fact_line("  channel", shown(channel.label) + unit);
  }
  return text;
}

/// A value in JSON; null if the value is missing.
Json number(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// The JSON about a stream, with all fitted lines of its clock.
Json json_of(const XdfStreamSurvey& one) {
  const XdfStream& s = one.stream;
  Json json{{"id", s.id},
            {"name", s.name},
            {"type", s.type},
            {"source_id", s.source_id},
            {"hostname", s.hostname},
            {"created_at", s.created_at},
            {"channel_format", name_of(s.format)},
            {"channel_count", s.channel_count},
            {"channels", Json::array()},
            {"nominal_rate_hz", s.nominal_rate_hz},
            {"rate_hz", one.rate_hz()},
            {"samples", one.samples},
            {"deduced_stamps", one.deduced},
            {"backward_stamps", one.backward},
            {"no_stamps", one.timeless},
            {"no_numbers", one.no_numbers},
            {"first_s", number(one.first)},
            {"last_s", number(one.last)},
            {"clock_offsets", one.clock_offsets},
            {"clock", Json::array()}};
  for (const XdfChannel& channel : s.channels) {
    json["channels"].push_back(
        {{"label", channel.label}, {"unit", channel.unit}, {"type", channel.type}});
  }
  for (const XdfClockLine& line : one.clock) {
    json["clock"].push_back({{"first_s", line.first},
                             {"last_s", line.last},
                             {"origin_s", line.origin},
                             {"offset_s", line.offset},
                             {"slope", line.slope},
                             {"offsets", line.offsets},
                             {"rms_residual_s", line.rms_residual},
                             {"largest_residual_s", line.largest_residual}});
  }
  return json;
}

}  // namespace

Description describe_survey(const std::string& path, const XdfSurvey& survey, Names names) {
  std::string text = path + "\n" + fact_line("format", "XDF 1.0") + size_line(survey.bytes);
  Json json{{"file", path}, {"kind", "xdf"}, {"bytes", survey.bytes}, {"streams", Json::array()}};
  for (const XdfStreamSurvey& one : survey.streams) {
    text += stream_lines(one, names);
    json["streams"].push_back(json_of(one));
  }
  return {text + findings_line(survey.findings.size(), path), json_text(json)};
}

}  // namespace kinalign
