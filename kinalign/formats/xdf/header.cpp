// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/xdf/header.h"

#include "kinalign/core/numbers.h"
#include "kinalign/formats/xdf/xml_walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace kinalign {

namespace {

using Path = std::span<const std::string_view>;

bool is(Path path, std::initializer_list<std::string_view> names) {
  return std::equal(path.begin(), path.end(), names.begin(), names.end());
}

/// Of two names of one format the usual one first.
constexpr std::array<std::pair<std::string_view, XdfFormat>, 9> formats{
    {{"int8", XdfFormat::int8},
     {"int16", XdfFormat::int16},
     {"int32", XdfFormat::int32},
     {"int64", XdfFormat::int64},
     {"float32", XdfFormat::float32},
     {"float", XdfFormat::float32},
     {"double64", XdfFormat::double64},
     {"double", XdfFormat::double64},
     {"string", XdfFormat::string}}};

std::optional<XdfFormat> format_of(std::string_view word) {
  for (const auto& [name, format] : formats) {
    if (name == word) return format;
  }
  return std::nullopt;
}

struct Words {
  std::string channel_count, rate, format;
};

/// The members that an element of the header fills; nullptr: another one.
std::string* place_of(Path path, XdfStream& stream, Words& words) {
  if (path.size() != 2 || path[0] != "info") return nullptr;
  const std::array<std::pair<std::string_view, std::string*>, 8> places{
      {{"name", &stream.name},
       {"type", &stream.type},
       {"source_id", &stream.source_id},
       {"hostname", &stream.hostname},
       {"created_at", &stream.created_at},
       {"channel_count", &words.channel_count},
       {"nominal_srate", &words.rate},
       {"channel_format", &words.format}}};
  for (const auto& [name, place] : places) {
    if (name == path[1]) return place;
  }
  return nullptr;
}

void visit(Path path, const std::string& text, XdfStream& stream, XdfChannel& channel) {
  if (path.size() == 4 && is(path, {"info", "desc", "channels", "channel"})) {
    stream.channels.push_back(std::move(channel));
    channel = {};
  }
  if (path.size() != 5 || !is(path.first(4), {"info", "desc", "channels", "channel"})) return;
  if (path[4] == "label") channel.label = text;
  if (path[4] == "unit") channel.unit = text;
  if (path[4] == "type") channel.type = text;
}

Failure refused(const std::string& expected, const std::string& word) {
  return Failure(Error{"", 0, expected, word.empty() ? "none" : "'" + shown(word) + "'"});
}

}  // namespace

std::string_view name_of(XdfFormat format) {
  for (const auto& [name, named] : formats) {
    if (named == format) return name;
  }
  return "";
}

Result<XdfStream> parse_xdf_header(std::uint32_t id, std::string_view xml,
                                   std::vector<Error>& notes) {
  XdfStream stream;
  stream.id = id;
  stream.xml = xml;
  Words words;
  XdfChannel channel;
  const auto walked = walk_xml(xml, [&](Path path, const std::string& text) {
    std::string* place = place_of(path, stream, words);
    if (place != nullptr && place->empty()) *place = text;
    visit(path, text, stream, channel);
  });
  if (!walked) notes.push_back(walked.error());
  const auto& count = words.channel_count;
  const char* const end = count.data() + count.size();
  const auto [behind, error] = std::from_chars(count.data(), end, stream.channel_count);
  if (error != std::errc{} || behind != end) return refused("a channel_count", count);
  const auto format = format_of(words.format);
  if (!format) return refused("a channel_format that is known", words.format);
  stream.format = *format;
  const bool rate = parse_number(words.rate, stream.nominal_rate_hz);
  if (!rate || !(stream.nominal_rate_hz >= 0.0)) {
    stream.nominal_rate_hz = 0.0;
    notes.push_back(refused("a nominal_srate", words.rate).value());
  }
  if (!stream.channels.empty() && stream.channels.size() != stream.channel_count) {
    notes.push_back(Error{"", 0, fmt::format("{} channels described", stream.channel_count),
                          std::to_string(stream.channels.size())});
    stream.channels.clear();
  }
  return stream;
}

}  // namespace kinalign
