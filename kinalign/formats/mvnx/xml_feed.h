// SPDX-License-Identifier: Apache-2.0
// An XML document fed in pieces, element by element. Expat parses; no other file includes it.
#pragma once

#include "kinalign/core/error.h"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

class XmlAttributes {
 public:
  /// name, value, name, value, ..., nullptr
  explicit XmlAttributes(const char* const* pairs) : pairs_(pairs) {}
  std::optional<std::string_view> find(std::string_view name) const;

 private:
  const char* const* pairs_;
};

/// Names come without a prefix: `frame` of `<mvn:frame>`. An error without a place gets the line.
class XmlHandler {
 public:
  virtual ~XmlHandler() = default;
  virtual Result<void> begin(std::string_view name, const XmlAttributes& attributes) = 0;
  /// `text`: the characters since the last tag.
  virtual Result<void> end(std::string_view name, std::string_view text) = 0;
};

/// Hostile documents fail: entities of their own, elements nested above 64, tags or texts above
/// 1 MiB.
class XmlFeed {
 public:
  explicit XmlFeed(std::string file);
  ~XmlFeed();
  XmlFeed(const XmlFeed&) = delete;
  XmlFeed& operator=(const XmlFeed&) = delete;

  Result<void> feed(std::string_view piece, XmlHandler& handler);
  /// The document has ended. Fails where its elements are not closed.
  Result<void> finish(XmlHandler& handler);
  /// The failure is that the document ends too early; what stands there is well-formed.
  bool ends_too_early() const;
  std::int64_t line() const;

 private:
  struct State;
  Result<void> begin(XmlHandler& handler);
  Result<void> parse(std::string_view piece, bool last, XmlHandler& handler);
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
