// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/xdf/header.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace kinalign {

namespace {

constexpr std::string_view blanks = " \t\r\n";

/// Appends the character number c in UTF-8.
void append_utf8(std::uint32_t c, std::string& out) {
  const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (c < 0x80) return put(c);
  if (c < 0x800) {
    put(0xc0 | c >> 6);
  } else if (c < 0x10000) {
    put(0xe0 | c >> 12);
    put(0x80 | (c >> 6 & 0x3f));
  } else {
    put(0xf0 | c >> 18);
    put(0x80 | (c >> 12 & 0x3f));
    put(0x80 | (c >> 6 & 0x3f));
  }
  put(0x80 | (c & 0x3f));
}

/// Appends the character of "#65" or "#x41"; false if there is no such character.
bool append_numbered(std::string_view name, std::string& out) {
  name.remove_prefix(1);
  const bool hex = name.starts_with('x') || name.starts_with('X');
  if (hex) name.remove_prefix(1);
  std::uint32_t code = 0;
  const char* const end = name.data() + name.size();
  const auto [behind, fault] = std::from_chars(name.data(), end, code, hex ? 16 : 10);
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  if (fault != std::errc{} || behind != end || code == 0 || code > 0x10ffff || surrogate) {
    return false;
  }
  append_utf8(code, out);
  return true;
}

bool append_entity(std::string_view name, std::string& out) {
  constexpr std::array<std::pair<std::string_view, char>, 5> named{
      {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}}};
  if (name.starts_with('#')) return append_numbered(name, out);
  for (const auto& [known, character] : named) {
    if (name == known) {
      out += character;
      return true;
    }
  }
  return false;
}

/// Appends text and resolves its entities. An '&' that begins none is kept.
void append_text(std::string_view text, std::string& out) {
  constexpr std::size_t longest_entity = 10;
  while (!text.empty()) {
    const auto mark = text.find('&');
    out += text.substr(0, mark);
    if (mark == std::string_view::npos) return;
    text.remove_prefix(mark + 1);
    const auto end = text.substr(0, longest_entity).find(';');
    if (end != std::string_view::npos && append_entity(text.substr(0, end), out)) {
      text.remove_prefix(end + 1);
    } else {
      out += '&';
    }
  }
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Parses the XML from tag to tag; path_ and texts_ belong to the open elements.
class Walk {
 public:
  Walk(std::string_view text, const XmlVisitor& visit) : text_(text), visit_(visit) {}

  Result<void> run() {
    while (at_ < text_.size()) {
      const auto mark = std::min(text_.find('<', at_), text_.size());
      if (!texts_.empty()) append_text(text_.substr(at_, mark - at_), texts_.back());
      at_ = mark;
      if (at_ < text_.size()) KA_TRY(tag());
    }
    if (!path_.empty()) return fault("</" + shown(path_.back()) + ">", "the end of the text");
    return {};
  }

 private:
  /// Handles one tag, comment, instruction or CDATA section.
  Result<void> tag() {
    if (skipped("<!--", "-->") || skipped("<?", "?>")) return {};
    constexpr std::string_view verbatim = "<![CDATA[";
    if (text_.substr(at_).starts_with(verbatim)) {
      const auto from = at_ + verbatim.size(),
                 end = std::min(text_.find("]]>", from), text_.size());
      if (!texts_.empty()) texts_.back() += text_.substr(from, end - from);
      at_ = std::min(end + 3, text_.size());
      return {};
    }
    if (text_.substr(at_).starts_with("<!")) return fault("elements", "a document type");
    const auto end = end_of_tag();
    if (end == std::string_view::npos) return fault("a tag's end", "the end of the text");
    std::string_view inside = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    if (inside.starts_with('/')) return close(inside.substr(1));
    const bool empty = inside.ends_with('/');
    if (empty) inside.remove_suffix(1);
    KA_TRY(open(inside));
    return empty ? close(path_.back()) : Result<void>{};
  }

  /// Position of the '>' that ends the tag: one outside of the attributes' values.
  std::size_t end_of_tag() const {
    char quote = 0;
    for (std::size_t k = at_; k < text_.size(); ++k) {
      const char c = text_[k];
      if (quote == 0 && c == '>') return k;
      if (quote == 0 && (c == '"' || c == '\'')) {
        quote = c;
      } else if (c == quote) {
        quote = 0;
      }
    }
    return std::string_view::npos;
  }

  bool skipped(std::string_view begin, std::string_view end) {
    if (!text_.substr(at_).starts_with(begin)) return false;
    const auto found = text_.find(end, at_ + begin.size());
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
    return true;
  }

  Result<void> open(std::string_view inside) {
    const std::string_view name = inside.substr(0, inside.find_first_of(blanks));
    if (name.empty()) return fault("an element's name", "none");
    if (path_.size() == deepest_xml) return fault("elements at most 32 deep", "deeper ones");
    path_.push_back(name);
    texts_.emplace_back();
    return {};
  }

  Result<void> close(std::string_view name) {
    name = name.substr(0, name.find_first_of(blanks));
    if (path_.empty() || path_.back() != name) {
      return fault(path_.empty() ? "the end of the text" : "</" + shown(path_.back()) + ">",
                   "</" + shown(name) + ">");
    }
    visit_(path_, trimmed(texts_.back()));
    path_.pop_back();
    texts_.pop_back();
    return {};
  }

  Result<void> fault(const std::string& expected, const std::string& found) const {
    return Failure(Error{"", 0, expected, found});
  }

  std::string_view text_;
  const XmlVisitor& visit_;
  std::size_t at_ = 0;
  std::vector<std::string_view> path_;
  std::vector<std::string> texts_;
};

using Path = std::span<const std::string_view>;

bool is(Path path, std::initializer_list<std::string_view> names) {
  return std::equal(path.begin(), path.end(), names.begin(), names.end());
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

/// The text that this element of the header fills; nullptr for any other element.
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

/// Takes the label, unit or type of a channel; adds the channel at its end.
void fill_channel(Path path, const std::string& text, XdfStream& stream, XdfChannel& channel) {
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

Result<void> walk_xml(std::string_view text, const XmlVisitor& visit) {
  return Walk(text, visit).run();
}

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
    fill_channel(path, text, stream, channel);
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
