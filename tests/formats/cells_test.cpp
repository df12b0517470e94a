// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/cells.h"

#include "tests/seeds.h"

#include "kinalign/core/error.h"

#include <doctest/doctest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>

using namespace kinalign;

namespace {

constexpr ColumnUse skipped{};
constexpr ColumnUse first{0, -1}, second{1, -1}, third{2, -1};

/// The result of reading a line of three numbers; nullopt: missing.
struct Cells {
  std::vector<std::optional<double>> numbers;
  std::string error;
};

Cells read(RowParser row, std::string_view line) {
  Cells out;
  if (const auto done = row.read(line); !done) {
    out.error = to_string(done.error());
    return out;
  }
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    out.numbers.push_back(row.missing[i] != 0 ? std::nullopt : std::optional(row.values[i]));
  }
  return out;
}

Cells read(char delimiter, std::string_view line) {
  return read(RowParser(delimiter, {first, second, third}), line);
}

const std::vector<std::optional<double>> one_two_three{1, 2, 3};

}  // namespace

TEST_CASE("blanks around a cell are no part of it, quotes are none, delimiters at the end are") {
  for (const std::string_view line :
       {"1,2,3", " 1 ,\t2 , 3 ", "1,2,3,", "1,2,3,,, ,", "\"1\",\" 2 \",3", "+1,2.,03", "1,2,3\r",
        "1.0e0,.2E1,+3e+0"}) {
    CAPTURE(line);
    const Cells cells = read(',', line);
    CHECK(cells.error == "");
    CHECK(cells.numbers == one_two_three);
  }
}

TEST_CASE("a run of blanks delimits once, in front of the first cell too") {
  for (const std::string_view line : {"1 2 3", "  1\t \t2   3", "1 2 3 \t ", "\"1\" 2 \"3\""}) {
    CAPTURE(line);
    const Cells cells = read(runs_of_blanks, line);
    CHECK(cells.error == "");
    CHECK(cells.numbers == one_two_three);
  }
  CHECK(read(runs_of_blanks, "1 2").error == "expected 3 cells, found 2");
  CHECK(read(runs_of_blanks, "1 2 3 4").error == "expected 3 cells, found 4");
  CHECK(read(runs_of_blanks, "").error == "expected 3 cells, found 0");
}

TEST_CASE("a tab that delimits is no blank around a cell: two of them hold a missing value") {
  CHECK(read('\t', "1\t\t3").numbers == std::vector<std::optional<double>>{1, std::nullopt, 3});
  CHECK(read('\t', "\t2\t").numbers ==
        std::vector<std::optional<double>>{std::nullopt, 2, std::nullopt});
}

TEST_CASE("an empty cell and nan in any letters are missing, and nothing else is") {
  for (const std::string_view cell : {"", "  ", "nan", "NaN", "-nan", "NAN", "\"\"", "\"nan\""}) {
    CAPTURE(cell);
    const Cells cells = read(',', "1," + std::string(cell) + ",3");
    CHECK(cells.error == "");
    CHECK(cells.numbers == std::vector<std::optional<double>>{1, std::nullopt, 3});
  }
  const std::vector<std::array<std::string, 2>> refused{
      {"nano", "nano"}, {"na", "na"},     {"null", "null"}, {"--nan", "--nan"},    {"2 2", "2 2"},
      {"2e", "2e"},     {"0x10", "0x10"}, {"1e15", "1e15"}, {"-1e15", "-1e15"},    {"\"2", "\"2"},
      {"2\"", "2\""},   {"inf", "inf"},   {"2;5", "2;5"},   {"\"2 3\"", "\"2 3\""}};
  for (const auto& [cell, found] : refused) {
    CAPTURE(cell);
    CHECK(read(',', "1," + cell + ",3").error == "expected a number in column 2, found " + found);
  }
  CHECK(read(',', "1,999999999999999,3").error == "");
}

TEST_CASE("what was missing in one row is not in the next") {
  RowParser row(',', {first, second});
  REQUIRE(row.read("1,"));
  CHECK(row.any_missing);
  REQUIRE(row.read("1,2"));
  CHECK_FALSE(row.any_missing);
  CHECK(row.missing == std::vector<std::uint8_t>{0, 0});
  CHECK(row.values == std::vector<double>{1, 2});
}

TEST_CASE("a column of which nothing is wanted may hold anything, a delimiter in quotes too") {
  const RowParser row(',', {first, skipped, second});
  for (const std::string_view line : {"1,,2", "1,noon,2", "1,\"a, b\",2", "1,\"a,,\" ,2"}) {
    CAPTURE(line);
    CHECK(read(row, line).numbers == std::vector<std::optional<double>>{1, 2});
  }
  // A quote that is never closed is a part of the cell.
  CHECK(read(row, "1,\"a,2").numbers == std::vector<std::optional<double>>{1, 2});
}

TEST_CASE("a text is what stands in its cell, and a column may be number and text at once") {
  RowParser row(',', {{0, 1}, {-1, 0}});
  REQUIRE(row.read(" 2.50 , \"ann, b\" "));
  CHECK(row.values == std::vector<double>{2.5});
  CHECK(row.texts == std::vector<std::string_view>{"ann, b", "2.50"});
}

TEST_CASE("a row is a row of its columns: fewer or more cells are counted") {
  CHECK(read(',', "").error == "expected 3 cells, found 1");
  CHECK(read(',', "1").error == "expected 3 cells, found 1");
  CHECK(read(',', "1,2").error == "expected 3 cells, found 2");
  CHECK(read(',', "1,2,3,4").error == "expected 3 cells, found 4");
  CHECK(read(',', "1,2,3,,5,").error == "expected 3 cells, found 5");
}

TEST_CASE("every number of seventeen digits is read as the C library reads it") {
  for (const std::uint64_t seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string line;
    std::vector<std::optional<double>> expected;
    for (int i = 0; i < 3; ++i) {
      std::array<char, 64> text{};
      const double wide =
          std::ldexp(static_cast<double>(random()) - 9e18, -static_cast<int>(20 + random() % 80));
      const char* form = random() % 2 == 0 ? "%.17g" : "%.9f";
      std::snprintf(text.data(), text.size(), form, wide);
      line += (i > 0 ? "," : "") + std::string(text.data());
      expected.emplace_back(std::strtod(text.data(), nullptr));
    }
    CAPTURE(line);
    CHECK(read(',', line).numbers == expected);
  }
}

TEST_CASE("the cells of a head are trimmed, without quotes, and none behind the last name") {
  using Names = std::vector<std::string>;
  CHECK(split_cells(" a , \"b c\",,d,, \r", ',') == Names{"a", "b c", "", "d"});
  CHECK(split_cells("  a\t b  c ", runs_of_blanks) == Names{"a", "b", "c"});
  CHECK(split_cells("", ',') == Names{});
  CHECK(split_cells(" ", runs_of_blanks) == Names{});
  CHECK(split_cells(",,", ',') == Names{});
}
