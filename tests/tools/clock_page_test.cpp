// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/markdown.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

using namespace kinalign;

namespace {

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<std::string> table_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("|")) lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> row_names(const std::string& text) {
  std::vector<std::string> names;
  for (const std::string& line : table_lines(text))
    names.push_back(line.substr(0, line.find(" |")));
  return names;
}

std::vector<std::string> captions(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("**")) lines.push_back(line);
  }
  return lines;
}

/// A page of half a minute and one seed for each part, for tests that do not depend on the figures.
const PageFigures& short_page() {
  static const PageFigures page = measure({.minute = {.minutes = 0.5, .seeds = 1, .first = 1},
                                           .ten_minutes = {.minutes = 0.5, .seeds = 1, .first = 2},
                                           .hour = {.minutes = 0.5, .seeds = 1, .first = 3},
                                           .bursts = {0.5, 1, 4, true}});
  return page;
}

}  // namespace

TEST_CASE("docs/clock_figures.md has the rows that the clock table makes, between its two marks") {
  const std::string page = text_of(KINALIGN_SOURCE_DIR "/docs/clock_figures.md");
  const auto begin = page.find("<!-- made by kinalign_clock_table --markdown --first ");
  const std::string mark = "<!-- end of what kinalign_clock_table made -->\n";
  const auto end = page.find(mark);
  REQUIRE(begin < end);
  REQUIRE(end != std::string::npos);
  const std::string made = markdown(short_page());
  CHECK(made.ends_with(mark));
  CHECK(row_names(page.substr(begin, end - begin)) == row_names(made));
  CHECK(captions(page.substr(begin, end - begin)) == captions(made));
}

TEST_CASE("each table of the page stands below what it shows, in which unit, and its bar") {
  std::string before;
  std::size_t tables = 0;
  std::istringstream made(markdown(short_page()));
  for (std::string line, last; std::getline(made, line); last = line) {
    if (line.starts_with("**")) before = line;
    if (!line.starts_with("| ") || last.starts_with("|")) continue;
    CAPTURE(line);
    ++tables;
    CHECK(before.find("--bars") != std::string::npos);
    const bool has_unit = before.find(" in ms") != std::string::npos ||
                          before.find(" in s,") != std::string::npos ||
                          before.find("in percent") != std::string::npos ||
                          before.find("without a unit") != std::string::npos;
    CHECK(has_unit);
    before.clear();  // each table has a text of its own before it
  }
  CHECK(tables == 8);
}

TEST_CASE("the page's bars are those that are judged") {
  PageFigures page = short_page();
  page.sets = page_sets(1);  // the page's own lengths, on which the bars depend
  const std::string made = markdown(page);
  const auto has = [&](const char* line) { return made.find(line) != std::string::npos; };
  CHECK(has("\n| bar: kinalign, live | 0.005 / 0.005 | 0.08 / 0.09 | 0.22 / 0.14 |"));
  CHECK(has("| 0.02 / 0.012 | 0.05 / 0.015 | none / none | 0.75 / 0.25 |\n"));  // without asymmetry
  CHECK(has("\n| bar: live, p99 | 0.08 | 1.3 | 5 | 2.2 | 3.2 | 5.5 | 11 |\n"));
  CHECK(has("\n| bar: both least | none | none | 100 / 150 | none | none | none | none |\n"));
  CHECK(has("\n| bar: kinalign, live | 0.006 / 0.01 | 0.11 / 0.16 |"));  // an hour, bursts
}

TEST_CASE("each set stands in the column that is named for it") {
  const PageFigures& page = short_page();
  CHECK(page.minute.front().of(Method::live).pooled ==
        measure(Link::wired, page.sets.minute).of(Method::live).pooled);
  CHECK(page.bursts.back().of(Method::live).pooled ==
        measure(Link::thin_floor, page.sets.bursts).of(Method::live).pooled);
  CHECK(page.hour.back().link == Link::thin_floor);
  CHECK(page.ten_minutes.size() == links);
}

TEST_CASE("figures are shown with the digits that tell") {
  PageFigures page = short_page();
  const auto live = static_cast<std::size_t>(Method::live);
  const std::array<double, links> minute{123.4e-3, 12.34e-3, 1.234e-3, 0.1234e-3,
                                         12.34e-6, 0.04e-6,  0.0};
  for (std::size_t i = 0; i < links; ++i) {
    page.minute[i].rows[live].pooled = minute[i];
    page.ten_minutes[i].rows[live].pooled = 1e-3;
    for (auto* tables : {&page.minute, &page.ten_minutes, &page.hour, &page.bursts}) {
      (*tables)[i].live = (*tables)[i].offline = {.frames = 30'000, .certified = 29'999};
    }
  }
  page.minute[0].live.wrong = 1;
  page.minute[0].offline.certified = 30'000;
  const std::string made = markdown(page);
  CHECK(
      made.find("\n| **kinalign, live** | 123 / 1.00 | 12.3 / 1.00 | 1.23 / 1.00 | 0.123 / 1.00 | "
                "0.0123 / 1.00 | 0.0000 / 1.00 | 0.0000 / 1.00 |\n") != std::string::npos);
  CHECK(made.find("\n| offline, 1 min | 100 | 99.99 | 99.99 |") != std::string::npos);
  CHECK(made.find("\nOf 1,679,945 certified stamps in all these runs 1 were wrong.\n") !=
        std::string::npos);
}
