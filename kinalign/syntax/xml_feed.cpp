// SPDX-License-Identifier: Apache-2.0
#include "kinalign/syntax/xml_feed.h"

#include <expat.h>

#include <algorithm>
#include <new>
#include <utility>

namespace kinalign {

namespace {

// Limits on the depth of elements, and on the bytes of a tag, a comment or a text.
constexpr int deepest = 64;
constexpr std::size_t longest = std::size_t{1} << 20;

/// Names are compared without their namespace prefix, because each document may choose its own
/// prefix.
std::string_view without_prefix(std::string_view name) {
  const auto colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

}  // namespace

std::optional<std::string_view> XmlAttributes::find(std::string_view name) const {
  // Elements have few attributes, so a search from the front is fast enough.
  for (const char* const* pair = pairs_; *pair != nullptr; pair += 2) {
    if (name == pair[0]) return pair[1];
  }
  return std::nullopt;
}

/// Expat's callbacks and their data. Expat can't pass on a handler's error, so `error` keeps the
/// first error. After an error the callbacks do nothing. `handler` belongs to the caller and is set
/// by every call of parse().
struct XmlFeed::State {
  std::string file;
  XML_Parser parser = nullptr;
  XmlHandler* handler = nullptr;
  std::string text;
  // `text` grows until the next tag. A call of end() passes it on and empties it.
  std::string start;  // first bytes of the document, kept until Expat gets them
  bool started = false;
  int depth = 0;
  std::uint64_t fed = 0, last_event = 0;  // positions in bytes
  std::optional<Error> error;

  std::int64_t line() const { return static_cast<std::int64_t>(XML_GetCurrentLineNumber(parser)); }

  /// Keeps the first error only, because later errors follow from it. Expat then ends XML_Parse()
  /// with an error, too.
  void stop(Error what) {
    if (error) return;
    if (what.file.empty()) {
      what.file = file;
      what.line = line();
    }
    error = std::move(what);
    XML_StopParser(parser, XML_FALSE);
  }
  void check(Result<void> result) {
    if (!result) stop(std::move(result).error());
  }

  static State& of(void* data) {
    // All bytes fed after the last event belong to an open tag or comment, which Expat keeps.
    State& self = *static_cast<State*>(data);
    self.last_event =
        static_cast<std::uint64_t>(std::max<XML_Index>(XML_GetCurrentByteIndex(self.parser), 0));
    return self;
  }

  static void begin(void* data, const char* name, const char** attributes) {
    State& self = of(data);
    if (self.error) return;
    // Text before a child element is dropped, because handlers receive text at end tags only.
    self.text.clear();
    if (++self.depth > deepest) {
      self.stop({"", 0, "elements nested at most 64 deep", "deeper elements"});
      return;
    }
    self.check(self.handler->begin(without_prefix(name), XmlAttributes(attributes)));
  }
  static void end(void* data, const char* name) {
    State& self = of(data);
    if (self.error) return;
    --self.depth;
    self.check(self.handler->end(without_prefix(name), self.text));
    self.text.clear();
  }
  static void characters(void* data, const char* text, int size) {
    State& self = of(data);
    if (self.error) return;
    self.text.append(text, static_cast<std::size_t>(size));
    if (self.text.size() > longest) self.stop({"", 0, "texts of at most 1 MiB", "a longer text"});
  }
  // An entity may contain further entities, so a small document could fill the memory.
  // NOLINTNEXTLINE(readability-function-size): Expat's signature
  static void entity(void* data, const char* name, int, const char*, int, const char*, const char*,
                     const char*, const char*) {
    of(data).stop({"", 0, "a document without entities of its own", shown(name)});
  }
};

XmlFeed::XmlFeed(std::string file) : state_(std::make_unique<State>()) {
  state_->file = std::move(file);
  state_->parser = XML_ParserCreate(nullptr);
  if (state_->parser == nullptr) throw std::bad_alloc();
  XML_SetUserData(state_->parser, state_.get());
  XML_SetElementHandler(state_->parser, State::begin, State::end);
  XML_SetCharacterDataHandler(state_->parser, State::characters);
  XML_SetEntityDeclHandler(state_->parser, State::entity);
}

XmlFeed::~XmlFeed() { XML_ParserFree(state_->parser); }

std::int64_t XmlFeed::line() const { return state_->line(); }

bool XmlFeed::ends_too_early() const {
  if (state_->error) return false;
  // Expat reports these errors if a document is cut off anywhere.
  switch (XML_GetErrorCode(state_->parser)) {
    case XML_ERROR_NO_ELEMENTS:
    case XML_ERROR_UNCLOSED_TOKEN:
    case XML_ERROR_UNCLOSED_CDATA_SECTION:
    case XML_ERROR_PARTIAL_CHAR:
      return true;
    default:
      return false;
  }
}

Result<void> XmlFeed::parse(std::string_view piece, bool last, XmlHandler& handler) {
  State& s = *state_;
  s.handler = &handler;
  // A piece has at most 64 KiB, so its size fits into an int.
  const auto status =
      XML_Parse(s.parser, piece.data(), static_cast<int>(piece.size()), last ? 1 : 0);
  s.fed += piece.size();
  // The handler's error is returned first, because Expat only reports that the handler stopped it.
  if (s.error) return Failure(*s.error);
  if (status == XML_STATUS_ERROR) {
    return Failure(
        Error{s.file, s.line(), "well-formed XML", XML_ErrorString(XML_GetErrorCode(s.parser))});
  }
  // Expat stores a tag or a comment until it is complete, so the length is limited here.
  if (!last && s.fed - std::min(s.last_event, s.fed) > longest) {
    return Failure(
        Error{s.file, s.line(), "tags and comments of at most 1 MiB", "a longer tag or comment"});
  }
  return {};
}

/// Expat guesses the encoding from the first piece. The first piece therefore has at least four
/// bytes, because one byte is not enough for the guess.
Result<void> XmlFeed::feed(std::string_view piece, XmlHandler& handler) {
  constexpr std::size_t enough = 4;
  State& s = *state_;
  if (!s.started) {
    const std::size_t some = std::min(piece.size(), enough - s.start.size());
    s.start += piece.substr(0, some);
    piece.remove_prefix(some);
    if (s.start.size() < enough) return {};
    KA_TRY(begin(handler));
  }
  // The length of a tag is checked after each piece, so a piece must be much smaller than the
  // limit.
  constexpr std::size_t most = std::size_t{64} << 10;
  for (; !piece.empty(); piece.remove_prefix(std::min(piece.size(), most))) {
    KA_TRY(parse(piece.substr(0, most), false, handler));
  }
  return {};
}

Result<void> XmlFeed::begin(XmlHandler& handler) {
  state_->started = true;
  return parse(state_->start, false, handler);
}

Result<void> XmlFeed::finish(XmlHandler& handler) {
  // If the document has fewer than four bytes, Expat has not received them yet.
  if (!state_->started) KA_TRY(begin(handler));
  return parse("", true, handler);
}

}  // namespace kinalign
