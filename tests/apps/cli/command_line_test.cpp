// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command_line.h"

#include "apps/cli/field_text.h"
#include "tests/apps/cli/fake_verb.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

const Page page{"mix", "", "", {}, {"out", "force", "jobs"}};

/// The options after a command line, or the message in its place.
struct Given {
  Mix mix;
  Common common;
  std::string message;
};

Given after(const std::vector<std::string>& words) {
  Given given;
  const Usage usage = describe_mix(given.mix);
  const auto parsed = parse_words(words, usage, common_fields(given.common, page));
  if (!parsed) given.message = to_string(parsed.error());
  return given;
}

}  // namespace

TEST_CASE("a flag takes its value from the next word or from behind an equals sign") {
  CHECK(after({"a", "--gap-ms", "20"}).mix.gap_ms == 20);
  CHECK(after({"a", "--gap-ms=20"}).mix.gap_ms == 20);
  CHECK(after({"a", "--interval-ms=3.6"}).mix.interval_ms == 3.6);
}

TEST_CASE("a switch stands alone and can be turned off") {
  CHECK(after({"--double", "a"}).mix.store_double);
  CHECK_FALSE(after({"--no-double", "a"}).mix.store_double);
  CHECK_FALSE(after({"--double=false", "a"}).mix.store_double);
}

TEST_CASE("letters stand for the flags that everyone types, alone or together") {
  const Given given = after({"-qv", "a", "-o", "take.h5"});
  CHECK(given.common.quiet);
  CHECK(given.common.verbose);
  CHECK(given.common.out == "take.h5");
  CHECK(after({"a", "-otake.h5"}).common.out == "take.h5");
}

TEST_CASE("a flag of many values may be given as often as wanted, another only once") {
  const Given given = after({"a", "--imu", "waist=w.csv", "--imu=ankle_left=a.csv"});
  CHECK(given.mix.imu == std::vector<std::string>{"waist=w.csv", "ankle_left=a.csv"});
  CHECK(after({"a", "--rows=2", "--rows=3"}).message ==
        "--rows: expected this flag once, found it twice");
}

TEST_CASE("words that are no flags go to the positionals, behind -- all of them") {
  CHECK(after({"a", "--rows", "2", "b"}).mix.files == std::vector<std::string>{"a", "b"});
  CHECK(after({"--", "--rows"}).mix.files == std::vector<std::string>{"--rows"});
  CHECK(after({}).message == "expected FILE (a file to mix), found nothing");
}

TEST_CASE("if one of two words is missing, the error names it") {
  std::vector<std::string> from, to;
  Usage usage;
  usage.positionals = {{"IN", "a file", &from}, {"OUT", "a new file", &to}};
  const auto parsed = parse_words({"a"}, usage, {});
  REQUIRE_FALSE(parsed);
  CHECK(to_string(parsed.error()) == "expected OUT (a new file), found nothing");
}

TEST_CASE("a word too many is refused by name") {
  CHECK(after({"1", "2", "3", "4", "5", "6", "7", "8", "9", "10"}).message ==
        "expected no more words, found 10");
}

TEST_CASE("a word too many is refused with what to do instead") {
  std::vector<std::string> file;
  Usage usage;
  usage.positionals = {{"FILE", "a file", &file, 1, 1, {}, "one at a time"}};
  CHECK(to_string(parse_words({"a", "b"}, usage, {}).error()) ==
        "expected no more words (one at a time), found b");
}

TEST_CASE("a TOML file as a word too many is taken for what --config names") {
  const auto parsed = parse_words({"lab.toml"}, {}, {});
  REQUIRE_FALSE(parsed);
  CHECK(to_string(parsed.error()) ==
        "expected no more words (did you mean --config lab.toml?), found lab.toml");
  CHECK(to_string(parse_words({"lab"}, {}, {}).error()) == "expected no more words, found lab");
}

TEST_CASE("an unknown flag is answered with the nearest known one") {
  CHECK(after({"a", "--gap-mss=3"}).message ==
        "expected a known flag (did you mean --gap-ms?), found --gap-mss");
  CHECK(after({"a", "--xyzzyplugh"}).message == "expected a known flag, found --xyzzyplugh");
  CHECK(after({"a", "-x"}).message.starts_with("expected a known flag"));
}

TEST_CASE("a flag that the verb has no use for is unknown to it") {
  CHECK(after({"a", "--seed", "3"}).message.starts_with("expected a known flag"));
}

TEST_CASE("values outside the range or the choices are refused with what may stand there") {
  CHECK(after({"a", "--gap-ms", "-3"}).message ==
        "--gap-ms: expected a number of at least 0, found -3");
  CHECK(after({"a", "--rows=99"}).message ==
        "--rows: expected a whole number from 1 to 10, found 99");
  CHECK(after({"a", "--rows=2.5"}).message ==
        "--rows: expected a whole number from 1 to 10, found 2.5");
  CHECK(after({"a", "--gap-ms="}).message ==
        "--gap-ms: expected a number of at least 0, found nothing");
  CHECK(after({"a", "--gap-ms=nan"}).message ==
        "--gap-ms: expected a number of at least 0, found nan");
  CHECK(after({"a", "--rotations", "euler"}).message ==
        "--rotations: expected spline or slerp, found euler");
}

TEST_CASE("a flag without its value is refused, also in front of the next flag") {
  CHECK(after({"a", "--gap-ms"}).message ==
        "--gap-ms: expected a value after it (NUMBER), found nothing after it");
  CHECK(after({"a", "--gap-ms", "--double"}).message ==
        "--gap-ms: expected a value after it (NUMBER), found --double");
}

TEST_CASE("what was given wins over what a file said in the meantime, and only that") {
  Mix flags;
  Mix manifest;
  flags.gap_ms = 10;
  flags.rows = 5;
  manifest.gap_ms = 99;
  manifest.rows = 7;
  const Sources sources{{"gap_ms", Source::flag}, {"rows", Source::project}};
  copy_given(describe_mix(flags).settings, describe_mix(manifest).settings, sources,
             Source::environment);
  CHECK(manifest.gap_ms == 10);
  CHECK(manifest.rows == 7);
}

TEST_CASE("an empty choice is not named, wherever it stands") {
  CHECK(any_of({"y", "z"}) == "y or z");
  CHECK(any_of({"", "x", "y", "z"}) == "x, y or z");
  CHECK(any_of({"x", "y", "z", ""}) == "x, y or z");
  CHECK(any_of({"x"}) == "x");
}
