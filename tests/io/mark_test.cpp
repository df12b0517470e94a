// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/mark.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

Mark named(const std::string& id) {
  Mark mark;
  mark.id = id;
  return mark;
}

}  // namespace

TEST_CASE("a mark that came within the time is a repeat, later it is a new one") {
  MarkRepeats repeats(5s);
  const HostTime begin{1000s};
  CHECK(!repeats.is_repeat(named("a"), begin));
  CHECK(repeats.is_repeat(named("a"), begin + 5s));
  CHECK(!repeats.is_repeat(named("b"), begin + 5s));
  CHECK(!repeats.is_repeat(named("a"), begin + 5s + 1ns));
}

TEST_CASE("marks without an id are never repeats") {
  MarkRepeats repeats(5s);
  CHECK(!repeats.is_repeat(named(""), HostTime{}));
  CHECK(!repeats.is_repeat(named(""), HostTime{}));
}

TEST_CASE("as many as are remembered and no more") {
  MarkRepeats repeats(600s);
  for (int i = 0; i < 5000; ++i) CHECK(!repeats.is_repeat(named(std::to_string(i)), HostTime{}));
  CHECK(repeats.is_repeat(named("4999"), HostTime{}));
  CHECK(repeats.is_repeat(named("3976"), HostTime{}));
  CHECK(!repeats.is_repeat(named("3975"), HostTime{}));
}

TEST_CASE("texts of marks are UTF-8 without control characters") {
  CHECK(is_mark_text("l\xc3\xa4uft\tgut\r\n"));
  CHECK(is_mark_text(""));
  CHECK(!is_mark_text("\x1b[2J"));
  CHECK(!is_mark_text(std::string_view("a\0b", 3)));
  CHECK(!is_mark_text("\x7f"));
  CHECK(!is_mark_text("\xff"));
}
