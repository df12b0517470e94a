// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/marks/vicon_trigger.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

namespace kinalign {

namespace {

using Refusal = ViconRefusal;

constexpr std::string_view blanks = " \t\r\n";

// ASCII characters of XML names; Vicon's elements and attributes need no others.
bool is_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '.' || c == ':';
}

// The XML reader below accepts only the form that Vicon's manuals show: an optional declaration,
// one outermost element, and elements in it that have attributes and no content. Everything else is
// refused: document types, comments, nested elements. So no entity can expand into more text than
// arrived.

/// Takes parts from the front of a text.
class Xml {
 public:
  explicit Xml(std::string_view text) : rest_(text) {}

  bool take(std::string_view what) {
    if (!rest_.starts_with(what)) return false;
    rest_.remove_prefix(what.size());
    return true;
  }
  void skip_blanks() {
    const auto at = rest_.find_first_not_of(blanks);
    rest_.remove_prefix(at == std::string_view::npos ? rest_.size() : at);
  }
  std::string_view take_name() {
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), is_name);
    return take_front(static_cast<std::size_t>(end - rest_.begin()));
  }
  /// Takes the text up to `end`, and `end` itself. Absent if `end` does not occur.
  std::optional<std::string_view> take_until(std::string_view end) {
    const auto at = rest_.find(end);
    if (at == std::string_view::npos) return std::nullopt;
    const auto front = take_front(at);
    rest_.remove_prefix(end.size());
    return front;
  }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view take_front(std::size_t size) {
    const auto front = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return front;
  }
  std::string_view rest_;
};

/// Appends the character number `code` in UTF-8.
void append_utf8(std::uint32_t code, std::string& out) {
  const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xc0 | code >> 6);
  } else if (code < 0x10000) {
    put(0xe0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3f));
  } else {
    put(0xf0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3f));
    put(0x80 | (code >> 6 & 0x3f));
  }
  put(0x80 | (code & 0x3f));
}

/// Appends the character of an entity "lt", "#10" or "#x0a". False if the entity is unknown.
bool append_entity(std::string_view name, std::string& out) {
  static constexpr std::array<std::pair<std::string_view, char>, 5> known{
      {{"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}}};
  for (const auto& [said, meant] : known) {
    if (name == said) out += meant;
    if (name == said) return true;
  }
  // A numeric entity is the number of a character. Control characters and surrogates are refused
  // later, with the text.
  const bool hex = name.starts_with("#x");
  if (!name.starts_with('#')) return false;
  name.remove_prefix(hex ? 2 : 1);
  std::uint32_t code = 0;
  const auto [at, error] =
      std::from_chars(name.data(), name.data() + name.size(), code, hex ? 16 : 10);
  if (error != std::errc{} || at != name.data() + name.size() || code > 0x10ffff) return false;
  append_utf8(code, out);
  return true;
}

/// The text with its entities resolved; absent if it has a '<' or an unknown entity.
std::optional<std::string> unescaped(std::string_view text) {
  if (text.find('<') != std::string_view::npos) return std::nullopt;
  std::string out;
  Xml rest(text);
  // The entities are replaced from left to right. The text after the last one remains in `rest`.
  while (const auto plain = rest.take_until("&")) {
    out += *plain;
    const auto entity = rest.take_until(";");
    if (!entity || !append_entity(*entity, out)) return std::nullopt;
  }
  out += rest.rest();
  return out;
}

/// Takes an attribute such as VALUE="33" and returns its decoded value; absent if there is none.
std::optional<std::string> take_attribute(Xml& xml, std::string_view& name) {
  xml.skip_blanks();
  name = xml.take_name();
  xml.skip_blanks();
  if (name.empty() || !xml.take("=")) return std::nullopt;
  xml.skip_blanks();
  const char* quote = xml.take("\"") ? "\"" : xml.take("'") ? "'" : "";
  if (*quote == 0) return std::nullopt;
  const auto value = xml.take_until(quote);
  return value ? unescaped(*value) : std::nullopt;
}

/// The value of one element, or of an attribute of the outermost element.
/// Names are views of the datagram; values are copies, because their entities are resolved.
struct Said {
  std::string_view name;
  std::string value;
};

/// The whole document: the name of the outermost element, then the values in it, its attribute
/// RESULT first.
struct Document {
  std::string_view name;
  std::vector<Said> said;
};

/// Takes an element such as <Name VALUE="dance"/>, after its '<'.
/// Two endings occur: "/>" and, for an element written with a separate end, "></Name>".
bool take_element(Xml& xml, Document& document) {
  Said said{xml.take_name(), {}};
  if (said.name.empty()) return false;
  for (;;) {
    xml.skip_blanks();
    if (xml.take("/>")) break;
    if (xml.take("></")) {
      if (xml.take_name() != said.name) return false;
      xml.skip_blanks();
      if (!xml.take(">")) return false;
      break;
    }
    std::string_view key;
    auto value = take_attribute(xml, key);
    if (!value) return false;
    if (key == "VALUE") said.value = std::move(*value);
  }
  document.said.push_back(std::move(said));
  return true;
}

/// Takes the whole document: an outermost element with elements that have no content.
/// The outermost element's attributes are read first. Only RESULT is kept.
bool take_document(Xml& xml, Document& document) {
  xml.skip_blanks();
  if (xml.take("<?xml") && !xml.take_until("?>")) return false;
  xml.skip_blanks();
  if (!xml.take("<")) return false;
  document.name = xml.take_name();
  if (document.name.empty()) return false;
  for (xml.skip_blanks(); !xml.take(">"); xml.skip_blanks()) {
    Said said;
    auto value = take_attribute(xml, said.name);
    if (!value) return false;
    said.value = std::move(*value);
    if (said.name == "RESULT") document.said.push_back(std::move(said));
  }
  for (xml.skip_blanks(); !xml.take("</"); xml.skip_blanks()) {
    if (!xml.take("<") || !take_element(xml, document)) return false;
  }
  if (xml.take_name() != document.name) return false;
  xml.skip_blanks();
  if (!xml.take(">")) return false;
  xml.skip_blanks();
  return xml.rest().empty();
}

// A number from 0 to `most`; the whole text must be the number.
std::optional<std::int64_t> whole_number(std::string_view text, std::int64_t most) {
  std::int64_t value = 0;
  const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && at == text.data() + text.size() && value >= 0;
  return whole && value <= most ? std::optional(value) : std::nullopt;
}

/// Takes the delay or the packet id.
/// The limit of the delay is that of a mark's latency, 60 s.
Refusal take_numbers(const Said& said, ViconTrigger& trigger) {
  constexpr std::int64_t most_delay_ms = 60'000;
  const bool is_delay = said.name == "Delay";
  const auto number = whole_number(said.value, is_delay ? most_delay_ms : INT64_MAX);
  if (!number) return Refusal::wrong_number;
  if (is_delay) {
    trigger.delay = std::chrono::milliseconds(*number);
  } else {
    trigger.packet_id = *number;
  }
  return Refusal::none;
}

std::string* text_named(std::string_view name, ViconTrigger& trigger) {
  if (name == "Name") return &trigger.name;
  if (name == "Notes") return &trigger.notes;
  if (name == "Description") return &trigger.description;
  if (name == "DatabasePath") return &trigger.database_path;
  return name == "RESULT" ? &trigger.result : nullptr;
}

/// Fills the trigger from the elements that it knows; each may occur once. Others are ignored.
Refusal take(const Document& document, ViconTrigger& trigger) {
  trigger.start = document.name == "CaptureStart";
  if (!trigger.start && document.name != "CaptureStop") return Refusal::not_capture;
  for (const Said& said : document.said) {
    const bool number = said.name == "Delay" || said.name == "PacketID";
    std::string* text = text_named(said.name, trigger);
    if (!number && text == nullptr) continue;
    // An element that occurs twice is refused, because the sender's intention is unknown.
    const auto times =
        std::count_if(document.said.begin(), document.said.end(),
                      [&said](const Said& other) { return other.name == said.name; });
    if (times > 1) return Refusal::twice;
    if (number) {
      if (const auto refusal = take_numbers(said, trigger); refusal != Refusal::none) {
        return refusal;
      }
      continue;
    }
    if (!is_mark_text(said.value)) return Refusal::wrong_text;
    *text = said.value;
  }
  return Refusal::none;
}

// Escapes the characters that XML does not allow in an attribute.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\t':
      case '\n':
      case '\r':  // unescaped, a reader of XML turns them into blanks
        out += "&#" + std::to_string(static_cast<int>(c)) + ';';
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace

const char* name_of(ViconRefusal refusal) {
  static constexpr std::array<const char*, vicon_refusals> names{
      "none", "too_long", "bad_xml", "not_capture", "wrong_number", "wrong_text", "twice"};
  return names[static_cast<std::size_t>(refusal)];
}

const char* expected_of(ViconRefusal refusal) {
  static constexpr std::array<const char*, vicon_refusals> texts{
      "a broadcast of Vicon's",
      "a broadcast of Vicon's of at most 1500 bytes",
      "a broadcast of Vicon's, one document of XML",
      "a CaptureStart or CaptureStop",
      "a Delay from 0 to 60000 ms and a whole PacketID",
      "texts in UTF-8 without control characters",
      "each element once"};
  return texts[static_cast<std::size_t>(refusal)];
}

ViconRefusal decode_vicon_trigger(std::string_view datagram, ViconTrigger& trigger) {
  trigger = {};
  if (datagram.size() > most_vicon_trigger) return Refusal::too_long;
  // A zero byte after the text is optional.
  while (datagram.ends_with('\0')) datagram.remove_suffix(1);
  Xml xml(datagram);
  Document document;
  const Refusal refusal = take_document(xml, document) ? take(document, trigger) : Refusal::bad_xml;
  if (refusal != Refusal::none) trigger = {};
  return refusal;
}

// The elements are in the order of Vicon's manuals. A start always has Notes and Description.
std::string encode_vicon_trigger(const ViconTrigger& trigger) {
  const std::string name = trigger.start ? "CaptureStart" : "CaptureStop";
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\"?><" + name;
  if (!trigger.result.empty()) out += " RESULT=\"" + escaped(trigger.result) + '"';
  out += '>';
  const auto put = [&out](const char* element, const std::string& value) {
    out += std::string("<") + element + " VALUE=\"" + escaped(value) + "\"/>";
  };
  put("Name", trigger.name);
  if (trigger.start || !trigger.notes.empty()) put("Notes", trigger.notes);
  if (trigger.start || !trigger.description.empty()) put("Description", trigger.description);
  put("DatabasePath", trigger.database_path);
  if (trigger.delay) put("Delay", std::to_string(trigger.delay->count() / 1'000'000));
  if (trigger.packet_id) put("PacketID", std::to_string(*trigger.packet_id));
  return out + "</" + name + '>';
}

Mark mark_of(const ViconTrigger& trigger) {
  Mark mark;
  mark.kind = trigger.start ? Mark::Kind::start : Mark::Kind::stop;
  mark.text = trigger.name;
  mark.latency = trigger.delay;
  if (trigger.packet_id) {
    mark.id = std::string(name_of(mark.kind)) + ' ' + std::to_string(*trigger.packet_id) + ' ' +
              trigger.name;
  }
  return mark;
}

}  // namespace kinalign
