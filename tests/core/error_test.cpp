// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/error.h"

#include "kinalign/core/progress.h"

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

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

TEST_CASE("an error is printed with its place, as far as it is known") {
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

TEST_CASE("an error shows no byte of what was found that is not UTF-8") {
  CHECK(to_string(Error{"M\xfcller.bvh", 0, "</chann\xe5l>", "\x9b\xf0\xf0"}) ==
        "M?ller.bvh: expected </chann?l>, found ???");
}

TEST_CASE("what is no UTF-8 is shown as one sign for each byte that Python's decoder can't read") {
  // Python 3.11.7: re.sub("[\udc80-\udcff]", "?", bytes.decode("utf-8", "surrogateescape"))
  const std::vector<std::pair<std::string, std::string>> cases{
      {"\x80", "?"},                               // tail alone
      {"\xc3", "?"},                               // lead alone
      {"M\xfcller", "M?ller"},                     // Latin-1
      {"\xc0\xaf", "??"},                          // / in two bytes
      {"\xc1\xbf", "??"},                          // U+007F in two
      {"\xc2\xa1", "\xc2\xa1"},                    // least of two
      {"\xe0\x80\xaf", "???"},                     // / in three
      {"\xe0\x9f\xbf", "???"},                     // U+07FF in three
      {"\xe0\xa0\x80", "\xe0\xa0\x80"},            // least of three
      {"\xf0\x80\x80\xaf", "????"},                // / in four
      {"\xf0\x8f\xbf\xbf", "????"},                // U+FFFF in four
      {"\xf0\x90\x80\x80", "\xf0\x90\x80\x80"},    // least of four
      {"\xed\x9f\xbf", "\xed\x9f\xbf"},            // below the surrogates
      {"\xed\xa0\x80", "???"},                     // the first
      {"\xed\xbf\xbf", "???"},                     // the last
      {"\xed\xa0\xbd\xed\xb8\x80", "??????"},      // a pair
      {"\xee\x80\x80", "\xee\x80\x80"},            // the first code point after the surrogates
      {"\xf4\x8f\xbf\xbf", "\xf4\x8f\xbf\xbf"},    // U+10FFFF
      {"\xf4\x90\x80\x80", "????"},                // U+110000
      {"\xf5\x80\x80\x80", "????"},                // beyond
      {"\xf8\x88\x80\x80\x80", "?????"},           // five bytes
      {"\xfc\x84\x80\x80\x80\x80", "??????"},      // six
      {"\xfe\xff", "??"},                          // never
      {"\xe2\x82", "??"},                          // cut after two of three
      {"\xf0\x9f\x98", "???"},                     // cut after three of four
      {"\xe2\x82x\xac", "??x?"},                   // a letter within
      {"\xe2\x82\xe2\x82\xac", "??\xe2\x82\xac"},  // cut, then whole
      {"\xc3\xbc\xbc", "\xc3\xbc?"},               // a tail too many
  };
  for (const auto& one : cases) {
    CAPTURE(one.second);
    CHECK(harmless("a" + one.first + "z") == "a" + one.second + "z");
    CHECK(shown(one.first) == one.second);
  }
}

TEST_CASE("letters of any script stay, what steers a terminal or turns a line does not") {
  const std::string letters = "M\u00fcller \u4e2d\u6587 \u05d0\u0628 \U0001f600 \u00a0";
  CHECK(harmless(letters) == letters);
  CHECK(harmless("\u0080\u009b\u009f|\u00a0") == "???|\u00a0");
  CHECK(harmless("\u202a\u202b\u202c\u202d\u202e|\u202f") == "?????|\u202f");
  CHECK(harmless("\u2066\u2067\u2068\u2069|\u206a") == "????|\u206a");
  CHECK(harmless("\u200e\u200f\u061c|\u200d") == "???|\u200d");
}

TEST_CASE("text of a file is shown short and without control characters") {
  CHECK(shown("a\tb\x1b[31mc\x7f") == "a?b?[31mc?");
  CHECK(shown("caf\xc3\xa9 \xe2\x82\xac") == "caf\xc3\xa9 \xe2\x82\xac");
  CHECK(shown("a\xc2\x9b"
              "31m\xe2\x80\xae"
              "b\xe2\x81\xa6") == "a?31m?b?");  // CSI, turned text
  CHECK(shown("\xc2") == "?");                  // half a character
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

TEST_CASE("an error's kind is no part of its message") {
  CHECK(Error{"a", 0, "b", "c"}.kind == ErrorKind::other);
  CHECK(to_string(Error{"a", 0, "b", "c", ErrorKind::directory}) ==
        to_string(Error{"a", 0, "b", "c"}));
}

TEST_CASE("an interruption is known by its kind, whatever the words of an error are") {
  const Error interrupted = interruption("walk.bvh");
  CHECK(to_string(interrupted) == "walk.bvh: expected the end of the job, found an interruption");
  CHECK(is_interruption(interrupted));
  CHECK_FALSE(is_interruption(Error{"", 0, interrupted.expected, interrupted.found}));
}

TEST_CASE("severities have names") {
  CHECK(to_string(Severity::note) == "note");
  CHECK(to_string(Severity::warning) == "warning");
  CHECK(to_string(Severity::error) == "error");
}
