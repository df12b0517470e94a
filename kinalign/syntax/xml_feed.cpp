// SPDX-License-Identifier: Apache-2.0
#include "kinalign/syntax/xml_feed.h"

#include <expat.h>

#include <algorithm>
#include <new>
#include <utility>

namespace kinalign {

namespace {

// The limits on the depth of elements, and on the bytes of a tag, a comment or a text.
constexpr int deepest = 64;
constexpr std::size_t longest = std::size_t{1} << 20;

/// Names count without their prefix, so readers need not know which one a document chose.
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

/// Expat's callbacks, and the error of the handler, which Expat can't pass on.
/// `handler` belongs to the caller and is set by every call of parse(). `error` is the first error;
/// after it the callbacks do nothing.
struct XmlFeed::State {
  std::string file;
  XML_Parser parser = nullptr;
  XmlHandler* handler = nullptr;
  std::string text;
  // `text` grows until the next tag. A call of end() hands it on and empties it.
  std::string start;  // first bytes of the document, until Expat has got them
  bool started = false;
  int depth = 0;
  std::uint64_t fed = 0, last_event = 0;  // bytes
  std::optional<Error> error;

  std::int64_t line() const { return static_cast<std::int64_t>(XML_GetCurrentLineNumber(parser)); }

  /// Keeps the first error only, because later ones follow from it. Expat then ends XML_Parse()
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
    // Bytes fed since the last event are those of an open tag or comment, which Expat keeps.
    State& self = *static_cast<State*>(data);
    self.last_event =
        static_cast<std::uint64_t>(std::max<XML_Index>(XML_GetCurrentByteIndex(self.parser), 0));
    return self;
  }

  static void begin(void* data, const char* name, const char** attributes) {
    State& self = of(data);
    if (self.error) return;
    // Characters before a child element belong to no end tag, so they are dropped.
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
  // Entities that expand to others could make a small document fill the memory.
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
  // The errors that a document gives if it is cut at any place.
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
  // Pieces are at most 64 KiB, so the size fits into an int.
  const auto status =
      XML_Parse(s.parser, piece.data(), static_cast<int>(piece.size()), last ? 1 : 0);
  s.fed += piece.size();
  // The handler's error comes first. Expat would only report that the parsing was stopped.
  if (s.error) return Failure(*s.error);
  if (status == XML_STATUS_ERROR) {
    return Failure(
        Error{s.file, s.line(), "well-formed XML", XML_ErrorString(XML_GetErrorCode(s.parser))});
  }
  // Expat keeps a tag or a comment until it is complete, so its length must be limited here.
  if (!last && s.fed - std::min(s.last_event, s.fed) > longest) {
    return Failure(
        Error{s.file, s.line(), "tags and comments of at most 1 MiB", "a longer tag or comment"});
  }
  return {};
}

/// Expat guesses the encoding from its first piece. It must get four bytes at once; otherwise it
/// would guess from a single one.
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
  // The length of a tag is checked after each piece, so a piece must be small beside the limit.
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
  // A document shorter than four bytes has not reached Expat yet.
  if (!state_->started) KA_TRY(begin(handler));
  return parse("", true, handler);
}

}  // namespace kinalign
