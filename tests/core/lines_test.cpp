// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/lines.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <random>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

/// "number:line" of each line of a text given in the pieces between the cuts.
std::vector<std::string> lines(const std::string& text, const std::vector<std::size_t>& cuts) {
  std::vector<std::string> found;
  LineSplitter splitter;
  const auto use = [&](std::string_view line) -> Result<void> {
    const char behind = *(line.data() + line.size());
    CHECK((behind == '\n' || behind == '\r' || behind == '\0'));
    found.push_back(std::to_string(splitter.number()) + ":" + std::string(line));
    return {};
  };
  std::size_t from = 0;
  for (const std::size_t cut : cuts) {
    CHECK(splitter.feed(std::string_view(text).substr(from, cut - from), use));
    from = cut;
  }
  CHECK(splitter.feed(std::string_view(text).substr(from), use));
  CHECK(splitter.finish(use));
  return found;
}

}  // namespace

TEST_CASE("lines come without their ends, numbered from one") {
  using All = std::vector<std::string>;
  CHECK(lines("a\nbc\r\n\nd", {}) == All{"1:a", "2:bc", "3:", "4:d"});
  CHECK(lines("a\n", {}) == All{"1:a"});
  CHECK(lines("\n", {}) == All{"1:"});
  CHECK(lines("", {}).empty());
  CHECK(lines("a\rb\r", {}) == All{"1:a\rb"});
}

TEST_CASE("lines do not depend on where the text is cut") {
  const std::string text = "a\r\n\r\nbcd\n\nef\r\r\ng";
  const auto whole = lines(text, {});
  for (std::size_t i = 0; i <= text.size(); ++i) {
    for (std::size_t j = i; j <= text.size(); ++j) CHECK(lines(text, {i, j}) == whole);
  }
}

TEST_CASE("a line longer than the longest is refused before it is held") {
  LineSplitter splitter;
  const auto use = [](std::string_view) -> Result<void> { return {}; };
  CHECK(splitter.feed("first\n", use));
  const std::string piece(LineSplitter::longest / 2, 'x');
  CHECK(splitter.feed(piece, use));
  CHECK(splitter.feed(piece, use));
  const auto more = splitter.feed("x", use);
  REQUIRE(!more);
  CHECK(to_string(more.error()) ==
        "line 2: expected a line of at most 1048576 bytes, found a longer line");
  LineSplitter another;
  CHECK(another.feed(std::string(LineSplitter::longest, 'x') + "\n", use));
  CHECK(!another.feed(std::string(LineSplitter::longest + 1, 'x') + "\n", use));
}

TEST_CASE("the first line that can't be used ends the text") {
  LineSplitter splitter;
  int used = 0;
  const auto use = [&](std::string_view line) -> Result<void> {
    ++used;
    if (line == "bad") return Failure(Error{"", splitter.number(), "good", "bad"});
    return {};
  };
  const auto result = splitter.feed("good\nbad\ngood\n", use);
  REQUIRE(!result);
  CHECK(result.error().line == 2);
  CHECK(used == 2);
}
