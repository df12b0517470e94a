// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/mark_keys.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;

namespace {

/// The marks of keys that are pressed a second apart, with the number of the key that stamps each.
std::vector<std::pair<Mark, std::int64_t>> marks_of(const std::string& keys) {
  MarkKeys reader;
  std::vector<std::pair<Mark, std::int64_t>> marks;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const HostTime now{std::chrono::seconds(i)};
    if (const auto mark = reader.take(keys[i], now)) {
      marks.emplace_back(mark->first, mark->second.time_since_epoch() / std::chrono::seconds(1));
    }
  }
  return marks;
}

}  // namespace

TEST_CASE("s, e and t are marks at once, other keys none") {
  const auto marks = marks_of("xste[A");
  REQUIRE(marks.size() == 3);
  CHECK(marks[0].first == Mark{Mark::Kind::start, "", std::nullopt, ""});
  CHECK(marks[0].second == 1);
  CHECK(marks[1].first.kind == Mark::Kind::t_pose);
  CHECK(marks[2].first.kind == Mark::Kind::stop);
}

TEST_CASE("a text is begun and ended by Enter, and stamped when it was begun") {
  const auto marks = marks_of("\nset\x7f\x7ft\xc3\xbc\x7f \xc3\xa9\rs");
  REQUIRE(marks.size() == 2);
  CHECK(marks[0].first == Mark{Mark::Kind::text, "st \xc3\xa9", std::nullopt, ""});
  CHECK(marks[0].second == 0);
  CHECK(marks[1].first.kind == Mark::Kind::start);
}

TEST_CASE("a text that is given up, empty or no text is no mark") {
  CHECK(marks_of("\nabc\x1b").empty());
  CHECK(marks_of("\n\n").empty());
  CHECK(marks_of("\n\xff\xfe\n").empty());  // no UTF-8
  CHECK(marks_of("\n" + std::string(2000, 'a') + "\n").at(0).first.text.size() == 500);
}

TEST_CASE("an arrow, a function key or a keypad's key is no key of ours, and Esc alone is one") {
  CHECK(single_keys("a\x1b[Ab\x1b[1;5Dc\x1b[3~d\x1bOte") == "abcde");
  CHECK(single_keys("\x1b") == "\x1b");
  CHECK(single_keys("a\x1b") == "a\x1b");
  CHECK(single_keys("\x1b\x1b[A") == "\x1b");
  CHECK(single_keys("a\x1b[1") == "a");  // cut off
  const auto marks = marks_of(single_keys("\nab\x1b[Dc\n"));
  REQUIRE(marks.size() == 1);
  CHECK(marks[0].first.text == "abc");
}

TEST_CASE("a text shows while it is typed") {
  MarkKeys keys;
  CHECK(!keys.typed());
  keys.take('\n', {});
  keys.take('a', {});
  CHECK(keys.typed() == "a");
}
