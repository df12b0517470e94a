// SPDX-License-Identifier: Apache-2.0
// Parses an XML document in pieces, element by element, with Expat. No other file includes Expat.
#pragma once

#include "kinalign/core/error.h"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// A view of Expat's array of attributes. It is valid during XmlHandler::begin() only.
class XmlAttributes {
 public:
  /// `pairs`: name, value, name, value, ..., nullptr
  explicit XmlAttributes(const char* const* pairs) : pairs_(pairs) {}
  std::optional<std::string_view> find(std::string_view name) const;

 private:
  const char* const* pairs_;
};

/// Receives the elements of a document. Names have no prefix: `frame` for `<mvn:frame>`. XmlFeed
/// adds the line to an error without a line. After an error no further function is called.
class XmlHandler {
 public:
  virtual ~XmlHandler() = default;
  /// Name and attributes are memory of Expat. The handler must copy what it needs after the call.
  virtual Result<void> begin(std::string_view name, const XmlAttributes& attributes) = 0;
  /// `text`: the characters since the previous tag.
  virtual Result<void> end(std::string_view name, std::string_view text) = 0;
};

/// Parses a document that arrives in pieces. Hostile documents fail: those that define entities,
/// nest elements deeper than 64, or have tags or texts above 1 MiB. Expat delivers a text in parts,
/// and this class joins the parts. It also keeps the first error with its line.
class XmlFeed {
 public:
  explicit XmlFeed(std::string file);
  ~XmlFeed();
  XmlFeed(const XmlFeed&) = delete;
  XmlFeed& operator=(const XmlFeed&) = delete;

  Result<void> feed(std::string_view piece, XmlHandler& handler);
  /// Call this at the end of the document. It fails if an element is still open.
  Result<void> finish(XmlHandler& handler);
  /// True if the document ends too early and has no other fault.
  bool ends_too_early() const;
  std::int64_t line() const;

 private:
  struct State;
  Result<void> begin(XmlHandler& handler);
  Result<void> parse(std::string_view piece, bool last, XmlHandler& handler);
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
