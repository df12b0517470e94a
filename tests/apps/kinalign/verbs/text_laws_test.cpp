// SPDX-License-Identifier: Apache-2.0
// Rules for any text that is laid out for people.
#include "apps/cli/console.h"
#include "apps/cli/help.h"
#include "apps/cli/terminal.h"
#include "apps/kinalign/text/summary.h"
#include "tests/apps/cli/fake_verb.h"
#include "tests/folder.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <sstream>

using namespace kinalign;

namespace {

/// Words of 1 to 30 characters, some not of ASCII and some in a colour.
std::string any_word(std::mt19937_64& random) {
  std::string word;
  for (std::size_t n = 1 + random() % (random() % 8 == 0 ? 30 : 9); n > 0; --n) {
    word += random() % 9 == 0 ? std::string("\xc2\xb1")
                              : std::string(1, static_cast<char>('a' + n % 26));
  }
  return random() % 6 == 0 ? "\x1b[31m" + word + "\x1b[0m" : word;
}

std::string any_line(std::mt19937_64& random, bool ascii = false) {
  std::string line;
  for (std::size_t n = random() % 40; n > 0; --n) {
    line += (line.empty() ? "" : " ") +
            (ascii ? std::string(1 + random() % 12, 'x') : any_word(random));
  }
  return line;
}

std::vector<std::string> words_in(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::vector<std::string> lines_in(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The width of the text on a terminal: colours take no room, each character takes one place.
std::size_t shown_width(std::string text) {
  for (auto at = text.find('\x1b'); at != std::string::npos; at = text.find('\x1b')) {
    text.erase(at, text.find('m', at) - at + 1);
  }
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

/// A verb whose texts contain all characters that are special in a shell or in roff.
Verb odd_verb() {
  const std::string text = "it's a \"test\": \\(bu [x] $HOME `id` 50 % - a--b {} ~ #";
  const Page page{"odd", text, ".B " + text, {{"kinalign odd " + text, "'" + text}}, {"out"}};
  return {page, [text](const auto& fill, const auto&) -> Result<int> {
            std::string value;
            Usage usage;
            usage.flags = {{"flag", ".SH " + text, &value}, {"other", "'br " + text, &value}};
            fill(usage);
            return 0;
          }};
}

}  // namespace

TEST_CASE("lines broken for a terminal fit it, word for word, but for words that never could") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::string text = (random() % 2 == 0 ? "  gaps   " : "") + any_line(random);
    const std::size_t width = 40 + random() % 80;
    const std::string found = broken(text + "\n", width);
    CHECK(words_in(found) == words_in(text));
    for (const std::string& line : lines_in(found)) {
      CHECK((shown_width(line) <= width || words_in(line).size() == 1));
    }
    if (shown_width(text) <= width) CHECK(found == text + "\n");
    CHECK(broken(found, width) == found);  // a text that already fits is not changed
  }
}

TEST_CASE("text wrapped for a page keeps its words, its width and its margin") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::string text = any_line(random, true);
    const std::size_t indent = random() % 30, width = indent + 12 + random() % 60;
    const auto lines = lines_in(std::string(indent, ' ') + wrapped(text, indent, width));
    std::string again;
    for (const std::string& line : lines) {
      CHECK(line.size() <= width);
      CHECK(std::min(line.find_first_not_of(' '), line.size()) == indent);
      again += line.substr(std::min(indent, line.size())) + " ";
    }
    CHECK(words_in(again) == words_in(text));
    // The first word of a line would not have fitted into the line before.
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const std::string first = words_in(lines[i]).front();
      CHECK(lines[i - 1].size() + 1 + first.size() > width);
    }
  }
}

TEST_CASE("a number is grouped in threes and loses no digit") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::uint64_t number = random() >> (random() % 64);
    std::string text = grouped(number);
    for (std::size_t i = 0; i < text.size(); ++i) {
      CHECK((text[text.size() - 1 - i] == ',') == (i % 4 == 3));
    }
    CHECK(text.front() != ',');
    std::erase(text, ',');
    CHECK(text == std::to_string(number));
  }
}

TEST_CASE("a duration is printed with its seconds") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const double s = 0.01 * static_cast<double>(random() % (random() % 2 == 0 ? 6000 : 3'000'000));
    const std::string text = duration_text(s);
    CAPTURE(text);
    double hours = 0.0, minutes = 0.0, rest = -1.0;
    if (std::sscanf(text.c_str(), "%lf h %lf min %lf s", &hours, &minutes, &rest) != 3) {
      hours = 0.0;
      if (std::sscanf(text.c_str(), "%lf min %lf s", &minutes, &rest) != 2) {
        minutes = 0.0;
        REQUIRE(std::sscanf(text.c_str(), "%lf s", &rest) == 1);
      }
    }
    CHECK(minutes < 60.0);
    const double said = 3600.0 * hours + 60.0 * minutes + rest;
    CHECK(said <= s + 0.005);
    CHECK(said > s - (s < 60.0 ? 0.006 : 1.0));
  }
}

TEST_CASE("a share is printed to one digit, and never as zero if it is not zero") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::uint64_t whole = 1 + random() % 1'000'000'000;
    const std::uint64_t part = (random() % (whole + 1)) >> (random() % 20);
    const std::string text = share_text(part, whole);
    const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
    CHECK(text.empty() == (part == 0));
    CHECK((text == "< 0.1 %") == (part > 0 && percent < 0.05));
    if (part == 0 || text.starts_with("<")) continue;
    CHECK(std::abs(std::stod(text) - percent) <= 0.0501);
    CHECK(std::stod(text) > 0.0);
  }
}

TEST_CASE("a progress line fits its terminal and its share only grows") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::uint64_t total = 1 + (random() >> (random() % 60));
    const double elapsed = std::exp(std::uniform_real_distribution<double>(-3.0, 12.0)(random));
    double before = 0.0;
    for (int k = 0; k <= 10; ++k) {
      const std::uint64_t done = total / 10 * static_cast<std::uint64_t>(k);
      const std::string line = progress_line("aligning", done, total, elapsed, 80);
      CHECK(line.size() <= 80);
      double share = -1.0;
      REQUIRE(std::sscanf(line.c_str(), "aligning %lf %%", &share) == 1);
      CHECK(share >= before);
      const double exact = 100.0 * static_cast<double>(done) / static_cast<double>(total);
      CHECK(std::abs(share - exact) <= 0.501);
      before = share;
      const std::size_t width = random() % 80;
      CHECK(progress_line("aligning", done, total, elapsed, width) == line.substr(0, width));
    }
  }
}

TEST_CASE("in a man page no text becomes a request of roff, and each shell takes its completion") {
  const std::vector<Verb> verbs{odd_verb(), mix_verb(nothing)};
  const std::vector<std::string> requests{".TH", ".SH", ".SS", ".TP", ".B", ".I",
                                          ".PP", ".RS", ".RE", ".EX", ".EE"};
  int sections = 0;
  for (const std::string& line : lines_in(man_page(verbs))) {
    CAPTURE(line);
    CHECK_FALSE(line.starts_with('\''));
    if (!line.starts_with('.')) continue;
    const std::string request = line.substr(0, line.find(' '));
    CHECK(std::count(requests.begin(), requests.end(), request) == 1);
    sections += request == ".SH" ? 1 : 0;
  }
  CHECK(sections == 6);  // name, synopsis, verbs, flags of every verb, settings, exit status
  const FreshFolder folder;
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    CAPTURE(shell);
    const std::string script = folder.write(shell, completion_script(shell, verbs));
    const std::string check = shell == "fish" ? "fish --no-execute" : shell + " -n";
    std::string command = "command -v ";
    command.append(shell).append(" >/dev/null || exit 0; ").append(check);
    command.append(" '").append(script).append("'");
    CHECK(std::system(command.c_str()) == 0);
  }
}
