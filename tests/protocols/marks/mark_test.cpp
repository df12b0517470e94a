// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/marks/mark.h"

#include "kinalign/recording/format.h"

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

TEST_CASE("a mark of a recording is JSON that reads to the same mark") {
  const RecordedMark start{{Mark::Kind::start, "S1 \"A02\"", 12500us, "b3f1-1"}, "call", "[::1]:7"};
  CHECK(to_json(start) ==
        R"({"kind":"start","source":"call","text":"S1 \"A02\"","latency_ms":12.5,)"
        R"("id":"b3f1-1","sender":"[::1]:7"})");
  const RecordedMark pose{{Mark::Kind::t_pose, "", std::nullopt, ""}, "keyboard", ""};
  CHECK(to_json(pose) == R"({"kind":"t_pose","source":"keyboard"})");
  for (const RecordedMark& mark : {start, pose}) {
    const auto again = to_mark(to_json(mark));
    REQUIRE(again);
    CHECK(again->mark == mark.mark);
    CHECK(again->source == mark.source);
    CHECK(again->sender == mark.sender);
  }
}

TEST_CASE("JSON that is no mark is none") {
  for (const char* json :
       {"", "[]", "{}", R"({"kind":"begin"})", R"({"kind":7})",
        R"({"kind":"start","latency_ms":-1})", R"({"kind":"start","latency_ms":60001})",
        R"({"kind":"start","latency_ms":"12"})"}) {
    CAPTURE(json);
    CHECK(!to_mark(json));
  }
}
