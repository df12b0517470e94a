// SPDX-License-Identifier: Apache-2.0
// Faults and odd texts in the XML of stream headers; xdf_test.cpp tests the contents of headers.
#include "kinalign/formats/xdf/header.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;

namespace {

struct Header {
  std::string name;
  std::vector<std::string> notes;
};

/// A sound header with `first` in front of its other elements, and `rest` behind them.
Header header_of(const std::string& first, const std::string& rest = "</info>") {
  std::vector<Error> notes;
  const auto stream =
      parse_xdf_header(1,
                       "<?xml version=\"1.0\" encoding=\"ASCII\"?>\n<info x='>'>" + first +
                           "<channel_count>1</channel_count><channel_format>int8</channel_format>"
                           "<nominal_srate>5</nominal_srate>" +
                           rest,
                       notes);
  if (!stream) return {"", {to_string(stream.error())}};
  Header out{stream->name, {}};
  for (const Error& note : notes) out.notes.push_back(note.expected + ", " + note.found);
  return out;
}

using Notes = std::vector<std::string>;

}  // namespace

TEST_CASE("an & that begins no entity is an &, and Latin-1 is read as such") {
  const auto name = [](const std::string& text) {
    const Header header = header_of("<name>" + text + "</name>");
    CHECK(header.notes.empty());
    return header.name;
  };
  CHECK(name(" a b\n") == "a b");
  CHECK(name("&lt;&gt;&amp;&quot;&apos; &#65;&#xe9;&#x20ac;") == "<>&\"' A\xc3\xa9\xe2\x82\xac");
  CHECK(name("B & C &lol; &#0; &#xd800; &#x110000; &#D &#x; &#65 &") ==
        "B & C &lol; &#0; &#xd800; &#x110000; &#D &#x; &#65 &");
  CHECK(name("a\x02"
             "b\x1f") == "a b");
  CHECK(name("\xb5V \xc2\xb5V") == "\xc2\xb5V \xc2\xb5V");
  CHECK(name("<!-- <b> -->x<![CDATA[<y>]]>") == "x<y>");
}

TEST_CASE("a header whose XML has a fault keeps the elements before it") {
  const Header torn = header_of("<name>N</name>", "<desc><a></desc></info>");
  CHECK(torn.name == "N");
  CHECK(torn.notes == Notes{"well-formed XML, mismatched tag"});
  CHECK(header_of("<name>N</name>", "").notes == Notes{"well-formed XML, no element found"});
  CHECK(header_of("<name></info>").notes == Notes{"expected a channel_count, found none"});
}

TEST_CASE("a header that defines entities is refused, so nothing can be expanded") {
  std::vector<Error> notes;
  CHECK_FALSE(parse_xdf_header(1, "<!DOCTYPE a [<!ENTITY l \"ha\">]><info>&l;</info>", notes));
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].expected == "a document without entities of its own");
}
