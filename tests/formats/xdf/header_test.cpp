// SPDX-License-Identifier: Apache-2.0
// Parsing the XML of stream headers; xdf_test.cpp tests the contents of headers.
#include "kinalign/formats/xdf/header.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;

namespace {

/// "a/b=text" for each element in the order of their ends, then the error.
std::vector<std::string> walked(std::string_view xml) {
  std::vector<std::string> lines;
  const auto result = walk_xml(xml, [&](auto path, const std::string& text) {
    std::string line;
    for (const auto name : path) line += (line.empty() ? "" : "/") + std::string(name);
    lines.push_back(line + "=" + text);
  });
  if (!result) lines.push_back(to_string(result.error()));
  return lines;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("xml: elements are visited where they end, with their own text") {
  CHECK(walked("<?xml version=\"1.0\"?>\n<a x='>'>\n <b> one </b><c/>\n two<d y=\"1\" />\n</a>") ==
        Lines{"a/b=one", "a/c=", "a/d=", "a=two"});
}

TEST_CASE("xml: entities are the five and numbers, and an & alone is an &") {
  CHECK(walked("<a>&lt;&gt;&amp;&quot;&apos; &#65;&#xe9;&#x20ac;&#x1f600;</a>") ==
        Lines{"a=<>&\"' A\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80"});
  CHECK(walked("<a>B & C &lol; &#0; &#xd800; &#x110000; &</a>") ==
        Lines{"a=B & C &lol; &#0; &#xd800; &#x110000; &"});
}

TEST_CASE("xml: comments and verbatim text") {
  CHECK(walked("<a><!-- <b> -->x<![CDATA[<&amp;>]]></a>") == Lines{"a=x<&amp;>"});
}

TEST_CASE("xml: a document type is refused, so nothing can be expanded") {
  CHECK(walked("<!DOCTYPE a [<!ENTITY l \"ha\">]><a>&l;</a>") ==
        Lines{"expected elements, found a document type"});
}

TEST_CASE("xml: what does not close in order is refused behind what could be visited") {
  CHECK(walked("<a><b>1</b><c></a>") == Lines{"a/b=1", "expected </c>, found </a>"});
  CHECK(walked("<a><b>1</b>") == Lines{"a/b=1", "expected </a>, found the end of the text"});
  CHECK(walked("<a></a></b>") == Lines{"a=", "expected the end of the text, found </b>"});
  CHECK(walked("<a") == Lines{"expected a tag's end, found the end of the text"});
  CHECK(walked("<>") == Lines{"expected an element's name, found none"});
}

TEST_CASE("xml: at most 32 elements stand in each other") {
  std::string deep;
  for (int k = 0; k < 32; ++k) deep += "<a>";
  CHECK(walked(deep).back() == "expected </a>, found the end of the text");
  CHECK(walked(deep + "<a>").back() == "expected elements at most 32 deep, found deeper ones");
}
