// SPDX-License-Identifier: Apache-2.0
// Rules for every reader of text: cutting a file into pieces changes nothing, and a broken file is
// read or refused with the file's name, never with a crash.
#include "tests/formats/table/text_formats.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <array>
#include <cctype>

using namespace kinalign;

namespace {

/// Checks that an error names a file of the format, and that rows have the properties that readers
/// promise.
void check_ordinary(const TextFormat& format, const Outcome& read) {
  CHECK(read.sound);
  if (!read.error.empty()) CHECK(read.error.starts_with(format.file));
  for (const std::string& finding : read.findings) {
    CAPTURE(finding);
    CHECK(finding.starts_with(format.file));
  }
}

/// Numbers of the text, as [begin, end) of their digits, signs and points.
std::vector<std::array<std::size_t, 2>> numbers_in(std::string_view text) {
  const auto of_number = [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-';
  };
  std::vector<std::array<std::size_t, 2>> out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!of_number(text[i])) continue;
    std::size_t end = i;
    while (end < text.size() && of_number(text[end])) ++end;
    out.push_back({i, end});
    i = end;
  }
  return out;
}

}  // namespace

TEST_CASE("a sound file of every text format is read without a word") {
  for (const TextFormat& format : all_text_formats()) {
    CAPTURE(format.file);
    const Outcome read = read_whole(format, format.text);
    CHECK(read.error == "");
    CHECK(read.findings.empty());
    CHECK(read.sound);
    CHECK(read.rows.size() >= 2);
  }
}

TEST_CASE("pieces of any sizes give the rows, findings and error of the whole file") {
  for (const std::uint64_t seed : fresh_seeds(40)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const TextFormat& format : all_text_formats()) {
      CAPTURE(format.file);
      // Cut somewhere, so that there are findings and errors to compare.
      const auto text =
          std::string_view(format.text).substr(0, random() % (format.text.size() + 1));
      const std::size_t most = 1 + random() % 200;
      const Outcome whole = read_whole(format, text);
      const Outcome cut = format.read(text, [&] { return 1 + random() % most; });
      CHECK(cut.rows == whole.rows);
      CHECK(cut.findings == whole.findings);
      CHECK(cut.error == whole.error);
    }
  }
}

TEST_CASE("line ends of two characters change no row of any format") {
  for (const TextFormat& format : all_text_formats()) {
    CAPTURE(format.file);
    std::string text;
    for (const char c : format.text) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    const Outcome read = read_whole(format, text);
    CHECK(read.error == "");
    CHECK(read.findings.empty());
    CHECK(read.rows == read_whole(format, format.text).rows);
  }
}

TEST_CASE("a file truncated at any byte keeps its complete rows and reports the missing ones") {
  for (const TextFormat& format : all_text_formats()) {
    CAPTURE(format.file);
    const Outcome whole = read_whole(format, format.text);
    for (std::size_t size = 0; size < format.text.size(); ++size) {
      CAPTURE(size);
      const Outcome cut = read_whole(format, std::string_view(format.text).substr(0, size));
      check_ordinary(format, cut);
      if (!cut.error.empty()) continue;
      // The last number of the last row may be only the beginning of the true one.
      REQUIRE(cut.rows.size() <= whole.rows.size());
      const std::size_t sure = cut.rows.empty() ? 0 : cut.rows.size() - 1;
      CHECK(std::equal(cut.rows.begin(), cut.rows.begin() + static_cast<std::ptrdiff_t>(sure),
                       whole.rows.begin()));
      if (size > 0 && format.text[size - 1] != '\n') CHECK(!cut.findings.empty());
    }
  }
}

TEST_CASE("with any bytes altered a file is read or refused, and what is read is sound") {
  for (const std::uint64_t seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const TextFormat& format : all_text_formats()) {
      CAPTURE(format.file);
      std::string text = format.text;
      for (std::uint64_t n = 1 + random() % 4; n > 0; --n) {
        text[random() % text.size()] = static_cast<char>(random());
      }
      CAPTURE(text);
      check_ordinary(format, read_whole(format, text));
    }
  }
}

TEST_CASE("no number that a file states takes memory or time, however wild") {
  for (const TextFormat& format : all_text_formats()) {
    CAPTURE(format.file);
    const auto numbers = numbers_in(format.text);
    const std::size_t every = 1 + numbers.size() / 60;
    for (std::size_t i = 0; i < numbers.size(); i += every) {
      const auto [begin, end] = numbers[i];
      for (const char* wild : {"99999999999999999999", "18446744073709551615", "4294967296",
                               "9223372036854775807", "-1", "1e300", "nan", "inf", "-0", ""}) {
        CAPTURE(begin);
        CAPTURE(wild);
        std::string text = format.text;
        text.replace(begin, end - begin, wild);
        check_ordinary(format, read_whole(format, text));
      }
    }
  }
}

TEST_CASE("a byte order mark in front belongs to no format") {
  for (const TextFormat& format : all_text_formats()) {
    CAPTURE(format.file);
    const Outcome read = read_whole(format, "\xef\xbb\xbf" + format.text);
    CHECK(read.error == "");
    CHECK(read.rows == read_whole(format, format.text).rows);
  }
}
