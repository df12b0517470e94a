// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/show_xdf.h"

#include "kinalign/formats/xdf/xdf.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// All streams have the same schema, because a sample contains only values. The names of channels
/// are in the stream's header, which is attached.
McapSchema sample_schema() {
  return {0, "kinalign.XdfSample", "jsonschema",
          R"({"type": "object", "properties": {"stamp": {"type": "number", "description": )"
          R"("s, the sender's clock, not corrected"}, "deduced": {"type": "boolean", )"
          R"("description": "not written: the one before and the nominal rate"}, )"
          R"("values": {"type": "array", "items": {"type": ["number", "string"]}, "description": )"
          R"("one a channel; of numbers NaN, Infinity and -Infinity as these words"}}})"};
}

/// Returns the time of a log entry; absent if a recorder can't have such a time. A recorder counts
/// seconds, often from the start of its machine. 4e9 s after 1970 is in 2096.
std::optional<Time> time_of(double s) {
  constexpr double latest_s = 4e9;
  if (!(s >= 0.0) || s > latest_s) return std::nullopt;
  return utc_time(std::llround(s * 1e9));
}

/// Converts a number. JSON has no NaN and no infinity, so they are written as in protobuf's JSON,
/// https://protobuf.dev/programming-guides/json/
Json value_json(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0.0 ? "Infinity" : "-Infinity";
  return value;
}
Json value_json(std::int64_t value) { return value; }
Json value_json(const std::string& value) { return value; }

/// Returns a sample with its stamp, whether the stamp was computed, and its values. A sample has
/// one value for each channel. All values of a stream have the same type.
std::string sample_json(const XdfSamples& samples, std::size_t t) {
  Json values = Json::array();
  std::visit(
      [&](const auto& all) {
        const std::size_t width = all.size() / samples.size();
        for (std::size_t c = 0; c < width; ++c) values.push_back(value_json(all[t * width + c]));
      },
      samples.values);
  const Json json = {{"stamp", samples.stamps[t]},
                     {"deduced", samples.deduced[t] != 0},
                     {"values", std::move(values)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Returns a channel's name: the stream's name without slashes and spaces. If other streams have
/// the same name, the id is added. Viewers would show a slash as a level of a tree, and spaces
/// cause problems in their paths.
std::string topic_of(const XdfStream& stream, bool alone) {
  std::string name = stream.name.empty() ? "stream" : stream.name;
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= ' ' || c == '/') c = '_';
  }
  return alone ? "/" + name : "/" + name + "/" + std::to_string(stream.id);
}

/// A stream's channel and its clock.
struct Channel {
  std::uint16_t id = 0;
  std::vector<XdfClockLine> lines;
};
using Channels = std::map<std::uint32_t, Channel>;  // by the stream's id

/// Adds a channel and the header of each stream. Attachments are at the beginning of the file.
Result<Channels> add_channels(const XdfSurvey& survey, ShownFile& out) {
  std::map<std::string, std::set<std::uint32_t>> ids;  // by the stream's name
  for (const XdfStreamSurvey& one : survey.streams) ids[one.stream.name].insert(one.stream.id);
  Channels channels;
  for (const XdfStreamSurvey& one : survey.streams) {
    const std::string topic = topic_of(one.stream, ids[one.stream.name].size() == 1);
    KA_TRY(out.attach(topic.substr(1) + ".xml", one.stream.xml));
    channels[one.stream.id] = {KA_TRY(out.add_channel(topic, sample_schema())), one.clock};
  }
  return channels;
}

/// Writes samples as messages. Returns the number of samples whose stamps are not times. These are
/// only counted, because the other samples are good.
Result<std::uint64_t> add_samples(const XdfSamples& samples, const Channel& channel,
                                  ShownFile& out) {
  std::uint64_t timeless = 0;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    const double stamp = samples.stamps[t];
    if (const auto at = time_of(corrected_xdf_stamp(channel.lines, stamp))) {
      KA_TRY(out.add(channel.id, *at, time_of(stamp).value_or(*at), sample_json(samples, t)));
    } else {
      ++timeless;
    }
  }
  return timeless;
}

}  // namespace

Result<Findings> show_xdf(FileSystem& files, const std::string& from, const std::string& out,
                          Overwrite overwrite, const Progress& progress) {
  // The file is read twice: first for the clocks of its streams, then for the samples.
  const XdfSurvey survey = KA_TRY(survey_xdf(files, from, progress));
  OutputFile file = KA_TRY(OutputFile::create(files, out, overwrite));
  ShownFile shown(file);
  KA_TRY(shown.begin());
  const Channels channels = KA_TRY(add_channels(survey, shown));
  std::uint64_t timeless = 0;
  FileFindings found{from};
  found.all = KA_TRY(read_xdf(files, from, progress, [&](const XdfItem& item) -> Result<void> {
    const auto* samples = std::get_if<XdfSamples>(&item);
    if (samples == nullptr) return {};
    // A stream without a header has no description, so its samples are omitted.
    const auto channel = channels.find(samples->stream);
    if (channel != channels.end())
      timeless += KA_TRY(add_samples(*samples, channel->second, shown));
    return {};
  }));
  if (timeless > 0) {
    found.add(Severity::warning, "stamps from 0 to 4e9 s",
              std::to_string(timeless) + " samples with other stamps",
              "these samples were left out");
  }
  KA_TRY(shown.finish());
  KA_TRY(file.commit());
  return found.all;
}

}  // namespace kinalign
