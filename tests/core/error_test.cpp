// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/error.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

Result<int> half(int n) {
  if (n % 2 != 0) return Failure(Error{"numbers.txt", 3, "an even number", std::to_string(n)});
  return n / 2;
}

Result<int> quarter(int n) {
  const int once = KA_TRY(half(n));
  return KA_TRY(half(once));
}

Result<int> eighth(int n) { return KA_TRY(half(KA_TRY(half(KA_TRY(half(n)))))); }

}  // namespace

TEST_CASE("an error is said with its place, as far as that is known") {
  CHECK(to_string(Error{"walk.bvh", 12, "2 frames", "1"}) ==
        "walk.bvh:12: expected 2 frames, found 1");
  CHECK(to_string(Error{"walk.bvh", 0, "a readable file", ""}) ==
        "walk.bvh: expected a readable file");
  CHECK(to_string(Error{"", 7, "a number", "'x'"}) == "line 7: expected a number, found 'x'");
  CHECK(to_string(Error{"", 0, "a number", "'x'"}) == "expected a number, found 'x'");
}

TEST_CASE("an error keeps to its line whatever the file is called") {
  CHECK(to_string(Error{"a\nb\x1b[31m.bvh", 1, "ROOT", "JOINT"}) ==
        "a?b?[31m.bvh:1: expected ROOT, found JOINT");
}

TEST_CASE("names on a terminal can't move its cursor") {
  CHECK(harmless("\x1b[31m.bvh\n  Hips\tx\n") == "?[31m.bvh\n  Hips?x\n");
}

TEST_CASE("text of a file is shown short and without control characters") {
  CHECK(shown("a\tb\x1b[31mc\x7f") == "a?b?[31mc?");
  CHECK(shown("caf\xc3\xa9 \xe2\x82\xac") == "caf\xc3\xa9 \xe2\x82\xac");
  CHECK(shown("a\xc2\x9b"
              "31m\xe2\x80\xae"
              "b\xe2\x81\xa6") == "a?31m?b?");  // CSI, turned text
  CHECK(shown("\xc2") == "\xc2");
  CHECK(shown(std::string(40, 'x')) == std::string(40, 'x'));
  CHECK(shown(std::string(41, 'x')) == std::string(40, 'x') + "...");
}

TEST_CASE("KA_TRY gives the value or ends the function with the error") {
  CHECK(quarter(12) == 3);
  REQUIRE(!quarter(6));
  CHECK(to_string(quarter(6).error()) == "numbers.txt:3: expected an even number, found 3");
  CHECK(to_string(quarter(5).error()) == "numbers.txt:3: expected an even number, found 5");
}

TEST_CASE("KA_TRY may stand in the argument of another") {
  CHECK(eighth(24) == 3);
  REQUIRE(!eighth(12));
  CHECK(to_string(eighth(12).error()) == "numbers.txt:3: expected an even number, found 3");
}

TEST_CASE("severities have names") {
  CHECK(to_string(Severity::note) == "note");
  CHECK(to_string(Severity::warning) == "warning");
  CHECK(to_string(Severity::error) == "error");
}
