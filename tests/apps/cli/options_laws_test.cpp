// SPDX-License-Identifier: Apache-2.0
// Rules for any options: as text, on a command line, in the environment and in files.
#include "apps/cli/command_line.h"
#include "apps/cli/field_text.h"
#include "tests/apps/cli/fake_verb.h"
#include "tests/folder.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

using namespace kinalign;

namespace {

Mix any_mix(std::mt19937_64& random) {
  Mix mix;
  mix.gap_ms =
      std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(random() % 40) - 60);
  mix.rows = 1 + static_cast<std::int64_t>(random() % 10);
  mix.rotations = random() % 2 == 0 ? "spline" : "slerp";
  mix.store_double = random() % 2 == 0;
  if (random() % 2 == 0) mix.interval_ms = static_cast<double>(random() % 1000) / 7.0;
  for (std::size_t n = random() % 3; n > 0; --n) mix.imu.push_back("n=" + std::to_string(n));
  for (std::size_t n = 1 + random() % 4; n > 0; --n) mix.files.push_back("f" + std::to_string(n));
  return mix;
}

/// All options of the verb in one line.
std::string told(Mix mix) {
  const Usage usage = describe_mix(mix);
  std::string text;
  for (const Fields* fields : {&usage.flags, &usage.settings}) {
    for (const Field& field : *fields) text += field.name + "=" + field_text(field) + " ";
  }
  for (const std::string& file : mix.files) text += file + " ";
  return text;
}

Result<int> tell(Mix& o, Call& call) {
  call.console.print(told(o));
  return 0;
}

using Words = std::vector<std::string>;

/// A flag with its value, as one word or two; a switch stands alone.
Words words_of(const Field& field, std::mt19937_64& random) {
  const std::string flag = flag_of(field.name), value = field_text(field);
  if (is_switch(field)) return {value == "true" ? flag : "--no-" + flag.substr(2)};
  if (random() % 2 == 0) return {flag + "=" + value};
  return {flag, value};
}

/// The options as a command line. Flags and files come in any order that keeps the order of each.
Words command_line(Mix mix, std::mt19937_64& random) {
  const Usage usage = describe_mix(mix);
  std::vector<Words> parts;
  for (const Field& field : usage.settings) {
    if (!field_text(field).empty()) parts.push_back(words_of(field, random));
  }
  std::shuffle(parts.begin(), parts.end(), random);
  const auto put_in_order = [&](const Words& some, const std::string& flag) {
    std::size_t at = 0;
    for (const std::string& one : some) {
      at += random() % (parts.size() - at + 1);
      parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(at++),
                   flag.empty() ? Words{one} : Words{flag, one});
    }
  };
  put_in_order(mix.imu, "--imu");
  put_in_order(mix.files, "");
  Words all{"mix"};
  for (const Words& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// A value as TOML text.
std::string toml_of(const Field& field) {
  const bool text = std::holds_alternative<std::string*>(field.value);
  return field.name + " = " + (text ? "\"" + field_text(field) + "\"" : field_text(field)) + "\n";
}

}  // namespace

TEST_CASE("the text of an option sets it to exactly the same value") {
  for (const auto seed : fresh_seeds(500)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    constexpr double most = 1.79e308;
    const auto same = [](double a, double b) {
      return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    };
    double number = std::bit_cast<double>(random()), other = 7.0;
    std::optional<double> maybe = number, none;
    auto whole = static_cast<std::int64_t>(random());
    std::optional<std::int64_t> maybe_whole = whole;
    bool yes = random() % 2 == 0;
    std::string text = "a b=\"c\"";
    if (!(std::abs(number) < most)) continue;
    const auto again = [](const Field& from, const Field& to) {
      const auto set = set_field(to, field_text(from));
      CHECK(set);
    };
    again({"", "", &number}, {"", "", &other, -most, most});
    CHECK(same(other, number));
    std::optional<double> maybe_other;
    again({"", "", &maybe}, {"", "", &maybe_other, -most, most});
    CHECK(maybe_other == maybe);
    CHECK(field_text({"", "", &none}).empty());
    std::int64_t whole_other = 0;
    again({"", "", &whole}, {"", "", &whole_other});
    CHECK(whole_other == whole);
    std::optional<std::int64_t> maybe_whole_other;
    again({"", "", &maybe_whole}, {"", "", &maybe_whole_other});
    CHECK(maybe_whole_other == maybe_whole);
    bool yes_other = !yes;
    again({"", "", &yes}, {"", "", &yes_other});
    CHECK(yes_other == yes);
    std::string text_other;
    again({"", "", &text}, {"", "", &text_other});
    CHECK(text_other == text);
  }
}

TEST_CASE("options are what the words say, in whatever order and form they stand") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Mix mix = any_mix(random);
    const Words words = command_line(mix, random);
    const Outcome outcome = Machine{}.run(tell, words);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 0);
    CHECK(outcome.out == told(mix));
  }
}

TEST_CASE(
    "an option is the same from a flag, the environment or either file, the nearer one wins") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const FreshFolder folder;
    Machine machine{.variables = {{"HOME", folder.path()}}, .folder = folder / "a/b"};
    Mix expected, user = any_mix(random), project = any_mix(random), variables = any_mix(random),
                  flags = any_mix(random);
    expected.files = {"f"};
    Words words{"mix", "f"};
    std::string users = "[mix]\n", projects = "[mix]\n";
    const Fields to = describe_mix(expected).settings;
    std::vector<Fields> from;
    for (Mix* mix : {&user, &project, &variables, &flags}) {
      from.push_back(describe_mix(*mix).settings);
    }
    const auto say = [&](const Field& field, std::size_t place) {
      if (place == 0) users += toml_of(field);
      if (place == 1) projects += toml_of(field);
      if (place == 2) machine.variables[variable_of(field.name)] = field_text(field);
      if (place < 3) return;
      const Words more = words_of(field, random);
      words.insert(words.end(), more.begin(), more.end());
    };
    for (std::size_t k = 0; k < 4 * to.size(); ++k) {
      const Field& field = from[k % 4][k / 4];
      if (random() % 2 == 0 || field_text(field).empty()) continue;
      // Each place takes precedence over the one before.
      REQUIRE(set_field(to[k / 4], field_text(field)));
      say(field, k % 4);
    }
    folder.write(".config/kinalign/config.toml", users);
    folder.write(random() % 2 == 0 ? "a/kinalign.toml" : "a/b/kinalign.toml", projects);
    const Outcome outcome = machine.run(tell, words);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 0);
    CHECK(outcome.out == told(expected));
  }
}

TEST_CASE("only the nearest kinalign.toml above the folder is used") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const FreshFolder folder;
    std::string path;
    std::int64_t nearest = Mix{}.rows;
    for (std::int64_t depth = 1; depth <= 6; ++depth) {
      path += (depth == 1 ? "" : "/") + std::string("d");
      folder.write(path + "/beside/kinalign.toml", "[mix]\nrows = 9\n");  // not above
      if (random() % 2 == 0) continue;
      folder.write(path + "/kinalign.toml", "[mix]\nrows = " + std::to_string(depth) + "\n");
      nearest = depth;
    }
    const auto rows = [](Mix& o, Call& call) -> Result<int> {
      call.console.print(std::to_string(o.rows));
      return 0;
    };
    const Machine machine{.folder = folder / path};
    CHECK(machine.run(rows, {"mix", "f"}).out == std::to_string(nearest));
  }
}

TEST_CASE("a value that an option can't have is refused in the same words wherever it stands") {
  const FreshFolder folder;
  for (const auto& one : std::vector<std::pair<std::string, std::string>>{{"gap_ms", "-1"},
                                                                          {"gap_ms", "many"},
                                                                          {"rows", "11"},
                                                                          {"rows", "2.5"},
                                                                          {"rotations", "euler"},
                                                                          {"double", "maybe"},
                                                                          {"interval_ms", "1e4"}}) {
    const std::string &name = one.first, &bad = one.second;
    CAPTURE(name);
    CAPTURE(bad);
    Mix mix;
    const Fields fields = describe_mix(mix).settings;
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&name](const Field& f) { return f.name == name; });
    const auto refused = set_field(*field, bad);
    REQUIRE_FALSE(refused);
    const auto says = [&](const std::string& place) {
      return "kinalign mix: " + place + ": " + to_string(refused.error()) + "\n";
    };
    Machine machine{.variables = {{variable_of(name), bad}}};
    CHECK(machine.run(tell, {"mix", "f"}).err.starts_with(says(variable_of(name))));
    const std::string file =
        folder.write("kinalign.toml", "[mix]\n\n" + name + " = \"" + bad + "\"\n");
    machine = Machine{.folder = folder.path()};
    CHECK(machine.run(tell, {"mix", "f"}).err.starts_with(says(file + ":3")));
    if (name == "double") continue;  // a switch has no value on a command line
    CHECK(Machine{}
              .run(tell, {"mix", "f", flag_of(name) + "=" + bad})
              .err.starts_with(says(flag_of(name))));
  }
}
