// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/xdf/header.h"

#include "kinalign/core/numbers.h"
#include "kinalign/core/utf8.h"
#include "kinalign/formats/cells.h"
#include "kinalign/syntax/xml_feed.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace kinalign {

namespace {

/// True if the text begins with a reference that XML allows: one of the five names, or the number
/// of a character. Expat would refuse any other, such as "&#D" or "&#0;".
bool begins_reference(std::string_view text) {
  constexpr std::array<std::string_view, 5> named{"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"};
  if (std::any_of(named.begin(), named.end(),
                  [&](std::string_view one) { return text.starts_with(one); })) {
    return true;
  }
  if (!text.starts_with("&#")) return false;
  const bool hex = text.substr(2).starts_with('x');
  const char* const end = text.data() + text.size();
  std::uint32_t code = 0;
  const auto [behind, fault] =
      std::from_chars(text.data() + (hex ? 3 : 2), end, code, hex ? 16 : 10);
  if (fault != std::errc{} || behind == end || *behind != ';') return false;
  if (code < 0x20) return code == '\t' || code == '\n' || code == '\r';
  return code <= 0x10ffff && (code < 0xd800 || code > 0xdfff) && code != 0xfffe && code != 0xffff;
}

/// The XML in UTF-8. Each '&' that begins no reference is escaped, because some programs write a
/// bare '&' in labels. XML allows no control characters, so each becomes a blank.
std::string mended(std::string_view xml) {
  std::string text = as_utf8(xml);
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char c) { return c < 0x20 && c != '\t' && c != '\n' && c != '\r'; }, ' ');
  std::string out;
  for (std::size_t from = 0;;) {
    const std::size_t at = text.find('&', from);
    out.append(text, from, at - from);
    if (at == std::string::npos) return out;
    out += begins_reference(std::string_view(text).substr(at)) ? "&" : "&amp;";
    from = at + 1;
  }
}

/// If a format has two names, the first one is the usual one.
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

/// Texts of the header that are parsed once the header is complete.
struct Words {
  std::string channel_count, rate, format;
};

/// Takes the texts of a header, element by element.
/// path_ holds the open elements, so an element is known by its place and not by its name alone.
class HeaderElements final : public XmlHandler {
 public:
  HeaderElements(XdfStream& stream, Words& words) : stream_(stream), words_(words) {}

  Result<void> begin(std::string_view name, const XmlAttributes&) override {
    path_.emplace_back(name);
    return {};
  }
  Result<void> end(std::string_view, std::string_view text) override {
    const std::string own(trimmed(text));
    std::string* place = path_.size() == 2 && path_[0] == "info" ? place_of(path_[1]) : nullptr;
    // The first text counts; <desc> may repeat the names of elements.
    if (place != nullptr && place->empty()) *place = own;
    fill_channel(own);
    path_.pop_back();
    return {};
  }

 private:
  /// The text that this element of <info> fills; nullptr for any other element.
  std::string* place_of(std::string_view name) const {
    const std::array<std::pair<std::string_view, std::string*>, 8> places{
        {{"name", &stream_.name},
         {"type", &stream_.type},
         {"source_id", &stream_.source_id},
         {"hostname", &stream_.hostname},
         {"created_at", &stream_.created_at},
         {"channel_count", &words_.channel_count},
         {"nominal_srate", &words_.rate},
         {"channel_format", &words_.format}}};
    for (const auto& [known, place] : places) {
      if (known == name) return place;
    }
    return nullptr;
  }

  /// Takes the label, unit or type of a channel; adds the channel at its end.
  void fill_channel(const std::string& text) {
    static const std::vector<std::string> of_channel{"info", "desc", "channels", "channel"};
    // The path must begin with info/desc/channels/channel.
    if (path_.size() < 4 || !std::equal(of_channel.begin(), of_channel.end(), path_.begin()))
      return;
    // The channel ends here; its label, unit and type came before.
    if (path_.size() == 4) stream_.channels.push_back(std::exchange(channel_, {}));
    if (path_.size() != 5) return;
    if (path_[4] == "label") channel_.label = text;
    if (path_[4] == "unit") channel_.unit = text;
    if (path_[4] == "type") channel_.type = text;
  }

  XdfStream& stream_;
  Words& words_;
  std::vector<std::string> path_;  // names from the outermost element to the open one
  XdfChannel channel_;
};

/// Reads the header's elements. The elements before a fault are kept.
Result<void> read_elements(std::string_view xml, XdfStream& stream, Words& words) {
  // The declaration may name another encoding than that of the text.
  if (xml.starts_with("<?xml")) xml.remove_prefix(std::min(xml.find("?>"), xml.size() - 2) + 2);
  HeaderElements elements(stream, words);
  XmlFeed feed("");
  // The text was converted to UTF-8, which is Expat's default.
  KA_TRY(feed.feed(mended(xml), elements));
  return feed.finish(elements);
}

Failure refused(const std::string& expected, const std::string& word) {
  return refuse(expected, word.empty() ? "none" : "'" + shown(word) + "'");
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
  const auto read = read_elements(xml, stream, words);
  // A fault late in the header leaves the elements before it usable.
  if (!read) notes.push_back(read.error());
  const auto& count = words.channel_count;
  // Without the number of channels no sample can be read.
  if (!parse_integer(count, stream.channel_count)) return refused("a channel_count", count);
  const auto format = format_of(words.format);
  if (!format) return refused("a known channel_format", words.format);
  stream.format = *format;
  // A wrong rate only matters for stamps that the file leaves out.
  const bool rate = parse_number(words.rate, stream.nominal_rate_hz);
  if (!rate || !(stream.nominal_rate_hz >= 0.0)) {
    stream.nominal_rate_hz = 0.0;
    notes.push_back(refused("a nominal_srate", words.rate).value());
  }
  // A wrong description is worse than none: labels would stand at wrong columns.
  if (!stream.channels.empty() && stream.channels.size() != stream.channel_count) {
    notes.push_back(Error{"", 0, fmt::format("{} channels described", stream.channel_count),
                          std::to_string(stream.channels.size())});
    stream.channels.clear();
  }
  return stream;
}

}  // namespace kinalign
