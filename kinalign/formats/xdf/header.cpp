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

/// True if the text begins with a reference that XML allows: one of five names, or the number of a
/// character. Expat refuses all others, such as "&#D" or "&#0;".
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

/// Converts the XML to UTF-8 and repairs it. Some programs write a bare '&' in labels, so each '&'
/// that begins no reference is escaped. XML does not allow control characters, so they become
/// blanks.
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

/// The names of the formats. If a format has two names, the usual one comes first.
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

/// Texts of the header. They are converted to numbers when the header is complete.
struct Words {
  std::string channel_count, rate, format;
};

/// Takes the texts of a header, element by element. path_ contains the open elements, because an
/// element is recognised by its path and not only by its name.
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
    // Only the first text is used, because <desc> may contain elements of the same names.
    if (place != nullptr && place->empty()) *place = own;
    fill_channel(own);
    path_.pop_back();
    return {};
  }

 private:
  /// The text that an element in <info> fills; nullptr for any other element.
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

  /// Takes the label, unit or type of a channel. At the end of the channel, adds the channel.
  void fill_channel(const std::string& text) {
    static const std::vector<std::string> of_channel{"info", "desc", "channels", "channel"};
    // Only elements below info/desc/channels/channel matter.
    if (path_.size() < 4 || !std::equal(of_channel.begin(), of_channel.end(), path_.begin()))
      return;
    // A channel ends here. Its label, unit and type are already known.
    if (path_.size() == 4) stream_.channels.push_back(std::exchange(channel_, {}));
    if (path_.size() != 5) return;
    if (path_[4] == "label") channel_.label = text;
    if (path_[4] == "unit") channel_.unit = text;
    if (path_[4] == "type") channel_.type = text;
  }

  XdfStream& stream_;
  Words& words_;
  std::vector<std::string> path_;  // names of the open elements, outermost first
  XdfChannel channel_;
};

/// Reads the elements of the header. If there is a fault, the elements before it are kept.
Result<void> read_elements(std::string_view xml, XdfStream& stream, Words& words) {
  // The declaration is skipped, because it may name a wrong encoding.
  if (xml.starts_with("<?xml")) xml.remove_prefix(std::min(xml.find("?>"), xml.size() - 2) + 2);
  HeaderElements elements(stream, words);
  XmlFeed feed("");
  // The text is UTF-8 now, which is Expat's default.
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
  // If the fault is late in the header, the elements before it can be used.
  if (!read) notes.push_back(read.error());
  const auto& count = words.channel_count;
  // Without the number of channels, samples can't be read.
  if (!parse_integer(count, stream.channel_count)) return refused("a channel_count", count);
  const auto format = format_of(words.format);
  if (!format) return refused("a known channel_format", words.format);
  stream.format = *format;
  // A wrong rate only affects stamps that are not in the file.
  const bool rate = parse_number(words.rate, stream.nominal_rate_hz);
  if (!rate || !(stream.nominal_rate_hz >= 0.0)) {
    stream.nominal_rate_hz = 0.0;
    notes.push_back(refused("a nominal_srate", words.rate).value());
  }
  // The channels are dropped if their number is wrong, because labels would belong to wrong
  // columns.
  if (!stream.channels.empty() && stream.channels.size() != stream.channel_count) {
    notes.push_back(Error{"", 0, fmt::format("{} channels described", stream.channel_count),
                          std::to_string(stream.channels.size())});
    stream.channels.clear();
  }
  return stream;
}

}  // namespace kinalign
