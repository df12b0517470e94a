// SPDX-License-Identifier: Apache-2.0
// Rules for any text: its lines, names, and how a message shows it.
#include "tests/seeds.h"

#include "kinalign/core/error.h"
#include "kinalign/core/lines.h"
#include "kinalign/core/nearest_name.h"
#include "kinalign/core/utf8.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <sstream>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

using Lines = std::vector<std::string>;

std::string random_text(const std::string& letters, std::size_t n, std::mt19937_64& random) {
  std::string text;
  for (std::size_t i = 0; i < n; ++i) text += letters[random() % letters.size()];
  return text;
}

/// The lines that the C++ library finds, each without one '\r' at its end.
Lines plain_lines(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.ends_with('\r')) line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

/// The number of letters inserted, left out, changed or swapped with a neighbour, by the
/// definition.
std::size_t plain_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min(
          {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

/// Control characters of one byte, and those of U+0080 to U+009F.
bool moves_a_cursor(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if (c < 0x20 || c == 0x7f || (c == 0xc2 && next >= 0x80 && next <= 0x9f)) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("any text has the lines that the C++ library finds, wherever it is cut") {
  for (const auto seed : fresh_seeds(500)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::string text = random_text("ab\r\n\n", random() % 60, random);
    Lines found;
    LineSplitter splitter;
    const auto use = [&](std::string_view line) -> Result<void> {
      found.emplace_back(line);
      CHECK(splitter.number() == static_cast<std::int64_t>(found.size()));
      return {};
    };
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t n = std::min<std::size_t>(random() % 9, text.size() - at);
      REQUIRE(splitter.feed(text.substr(at, n), use));
      at += n;
      CHECK(splitter.within_line() == (at > 0 && text[at - 1] != '\n'));
    }
    REQUIRE(splitter.finish(use));
    CHECK(found == plain_lines(text));
  }
}

TEST_CASE("no text of a file, whole or cut, moves a terminal's cursor") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string text(random() % 100, '\0');
    for (char& c : text) {
      c = static_cast<char>(random() % 3 == 0 ? random() : 0xc2 - random() % 0x40);
    }
    const std::string said = harmless(text);
    CHECK_FALSE(moves_a_cursor(shown(text)));
    CHECK(shown(text).size() <= 43);
    CHECK((is_utf8(shown(text)) && is_utf8(said)));
    CHECK_FALSE(moves_a_cursor(to_string(Error{text, 3, "a", "b"})));
    CHECK(harmless(said) == said);
    CHECK(std::count(said.begin(), said.end(), '\n') == std::count(text.begin(), text.end(), '\n'));
    std::string without_lines = said;
    std::replace(without_lines.begin(), without_lines.end(), '\n', ' ');
    CHECK_FALSE(moves_a_cursor(without_lines));
  }
}

TEST_CASE("the nearest name is as near as any, and none is given where all are far") {
  for (const auto seed : fresh_seeds(500)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto word = [&random] { return random_text("abc", 1 + random() % 9, random); };
    std::vector<std::string> known(1 + random() % 6);
    for (std::string& one : known) one = word();
    const std::string name = word(), found = nearest_name(name, known);
    const std::size_t near = std::max<std::size_t>(1, name.size() / 3);
    std::size_t least = 100;
    for (const std::string& one : known) least = std::min(least, plain_distance(name, one));
    CAPTURE(name);
    CAPTURE(found);
    if (least <= near) {
      CHECK(plain_distance(name, found) == least);
    } else if (!found.empty()) {
      CHECK(name.size() >= 3);
      CHECK(found.starts_with(name));
    } else {
      const auto begun = [&name](const std::string& one) { return one.starts_with(name); };
      CHECK((name.size() < 3 || std::none_of(known.begin(), known.end(), begun)));
    }
    if (!found.empty()) CHECK(std::count(known.begin(), known.end(), found) > 0);
    CHECK(nearest_name(known.back(), known) == known.back());
  }
}
