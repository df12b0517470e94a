// SPDX-License-Identifier: Apache-2.0
#include "kinalign/syntax/xml_feed.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

class Told final : public XmlHandler {
 public:
  std::string all;
  Result<void> begin(std::string_view name, const XmlAttributes& attributes) override {
    if (name == "refused") return Failure(Error{"", 0, "another element", "this one"});
    all += "<" + std::string(name) + ":" + std::string(attributes.find("a").value_or("-")) + ">";
    return {};
  }
  Result<void> end(std::string_view name, std::string_view text) override {
    all += std::string(text) + "</" + std::string(name) + ">";
    return {};
  }
};

struct Outcome {
  std::string all, error;
};

Outcome told(const std::string& text, std::size_t piece = 7) {
  XmlFeed feed("x.mvnx");
  Told handler;
  Result<void> result;
  for (std::size_t at = 0; at < text.size() && result; at += piece) {
    result = feed.feed(std::string_view(text).substr(at, piece), handler);
  }
  if (result) result = feed.finish(handler);
  return {handler.all, result ? "" : to_string(result.error())};
}

std::string times(std::size_t count, const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += text;
  return out;
}

}  // namespace

TEST_CASE("elements come with attributes, text and without prefixes, wherever the text is cut") {
  const std::string text =
      "<?xml version=\"1.0\"?><!-- <b/> --><m:r a='1' b='2'><c>x &amp; y</c>\n<d a='&#65;'/></m:r>";
  for (std::size_t piece = 1; piece <= text.size(); ++piece) {
    CAPTURE(piece);
    const auto found = told(text, piece);
    CHECK(found.error == "");
    CHECK(found.all == "<r:1><c:->x & y</c><d:A></d></r>");
  }
}

TEST_CASE("a document has the same fault wherever its first bytes are cut") {
  const std::string no_xml("0\0\7vnx=", 7);  // may be UTF-16, by its second byte
  for (std::size_t piece = 1; piece <= no_xml.size(); ++piece) {
    CAPTURE(piece);
    CHECK(told(no_xml, piece).error == "x.mvnx:1: expected well-formed XML, found syntax error");
  }
  CHECK(told("<a").error == "x.mvnx:1: expected well-formed XML, found unclosed token");
}

TEST_CASE("a fault of the document or of the handler has its line") {
  CHECK(told("<a>\n<b>\n</a>").error == "x.mvnx:3: expected well-formed XML, found mismatched tag");
  CHECK(told("<a>\n<b>").error == "x.mvnx:2: expected well-formed XML, found no element found");
  CHECK(told("<a>\n\n<refused/></a>").error ==
        "x.mvnx:3: expected another element, found this one");
  CHECK(told("").error == "x.mvnx:1: expected well-formed XML, found no element found");
}

TEST_CASE("hostile documents are refused before they take memory") {
  CHECK(told("<!DOCTYPE a [\n<!ENTITY x 'xxxxxxxxxx'>]><a>&x;</a>").error ==
        "x.mvnx:2: expected a document without entities of its own, found x");
  CHECK(told(times(65, "<a>")).error ==
        "x.mvnx:1: expected elements nested at most 64 deep, found deeper elements");
  CHECK(told(times(64, "<a>") + times(64, "</a>")).error == "");
  const std::string long_text(std::size_t{2} << 20, 'x');
  CHECK(told("<a>" + long_text + "</a>", 65'536).error ==
        "x.mvnx:1: expected texts of at most 1 MiB, found a longer text");
  CHECK(told("<a b='" + long_text + "'/>", 65'536).error ==
        "x.mvnx:1: expected tags and comments of at most 1 MiB, found a longer tag or comment");
}

TEST_CASE("a long document of short elements is read to its end") {
  const auto found = told("<a>" + times(300'000, "<b>12345</b>\n") + "</a>", 100'000);
  CHECK(found.error == "");
  CHECK(found.all.size() > 3'000'000);
}
