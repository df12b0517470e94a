// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/marks/vicon_trigger.h"

#include "kinalign/core/numbers.h"
#include "kinalign/syntax/xml_feed.h"

#include <algorithm>
#include <array>
#include <vector>

namespace kinalign {

namespace {

using Refusal = ViconRefusal;

constexpr std::string_view blanks = " \t\r\n";

// Reads a number from 0 to `most`. The whole text must be the number.
std::optional<std::int64_t> number_up_to(std::int64_t most, std::string_view text) {
  std::int64_t value = 0;
  const bool fits = parse_integer(text, value) && value >= 0 && value <= most;
  return fits ? std::optional(value) : std::nullopt;
}

std::string* text_named(std::string_view name, ViconTrigger& trigger) {
  if (name == "Name") return &trigger.name;
  if (name == "Notes") return &trigger.notes;
  if (name == "Description") return &trigger.description;
  return name == "DatabasePath" ? &trigger.database_path : nullptr;
}

/// Fills a trigger from the outermost element and its child elements. A child element has an
/// attribute VALUE and no content. An error without text stops the parser, and `refusal()` returns
/// the reason.
class TriggerReader : public XmlHandler {
 public:
  explicit TriggerReader(ViconTrigger& trigger) : trigger_(trigger) {}

  Result<void> begin(std::string_view name, const XmlAttributes& attributes) override {
    if (++depth_ > 2) return stop(Refusal::bad_xml);
    if (depth_ == 2) return take(name, attributes.find("VALUE").value_or(""));
    trigger_.start = name == "CaptureStart";
    if (!trigger_.start && name != "CaptureStop") return stop(Refusal::not_capture);
    return take_text(attributes.find("RESULT").value_or(""), trigger_.result);
  }
  Result<void> end(std::string_view /*name*/, std::string_view text) override {
    --depth_;
    const bool blank = text.find_first_not_of(blanks) == std::string_view::npos;
    return blank ? Result<void>() : stop(Refusal::bad_xml);
  }
  Refusal refusal() const { return refusal_; }

 private:
  Result<void> stop(Refusal refusal) {
    refusal_ = refusal;
    return Failure(Error{});
  }

  /// Takes a child element. Unknown elements are ignored.
  Result<void> take(std::string_view name, std::string_view value) {
    constexpr std::int64_t most_delay_ms = 60'000;  // also the limit of a mark's latency
    std::string* text = text_named(name, trigger_);
    const bool is_delay = name == "Delay";
    if (text == nullptr && !is_delay && name != "PacketID") return {};
    // An element that occurs twice is refused, because it is not clear which value the sender
    // meant.
    if (std::find(taken_.begin(), taken_.end(), name) != taken_.end()) return stop(Refusal::twice);
    taken_.emplace_back(name);
    if (text != nullptr) return take_text(value, *text);
    const auto number = number_up_to(is_delay ? most_delay_ms : INT64_MAX, value);
    if (!number) return stop(Refusal::wrong_number);
    if (is_delay) {
      trigger_.delay = std::chrono::milliseconds(*number);
    } else {
      trigger_.packet_id = *number;
    }
    return {};
  }

  Result<void> take_text(std::string_view value, std::string& text) {
    if (!is_mark_text(value)) return stop(Refusal::wrong_text);
    text = value;
    return {};
  }

  ViconTrigger& trigger_;
  std::vector<std::string> taken_;  // names of the elements so far
  int depth_ = 0;
  Refusal refusal_ = Refusal::none;
};

/// Decodes the document. Every error of the XML parser is refused as bad XML.
Refusal read(std::string_view document, ViconTrigger& trigger) {
  // Broadcasts contain neither document types nor comments. Without a document type, no entity can
  // be defined.
  if (document.find("<!") != std::string_view::npos) return Refusal::bad_xml;
  TriggerReader reader(trigger);
  XmlFeed feed("");
  if (feed.feed(document, reader) && feed.finish(reader)) return Refusal::none;
  return reader.refusal() == Refusal::none ? Refusal::bad_xml : reader.refusal();
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
  // A zero byte may follow the text. Some programs send blanks in front of the XML declaration,
  // although XML does not allow them.
  while (datagram.ends_with('\0')) datagram.remove_suffix(1);
  datagram.remove_prefix(std::min(datagram.find_first_not_of(blanks), datagram.size()));
  const Refusal refusal = read(datagram, trigger);
  if (refusal != Refusal::none) trigger = {};
  return refusal;
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
