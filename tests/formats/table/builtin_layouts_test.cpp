// SPDX-License-Identifier: Apache-2.0
// Each built-in layout is recognised by a file that has exactly its columns.
#include "tests/formats/reading.h"

#include "kinalign/formats/table/table_reader.h"
#include "kinalign/sources/formats.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

std::string between(const TableLayout& layout) {
  return layout.delimiter == runs_of_blanks ? " " : std::string(1, layout.delimiter);
}

std::string named(std::string pattern, const std::string& member) {
  for (const std::string_view place : {"{joint}", "{node}"}) {
    const auto at = pattern.find(place);
    if (at != std::string::npos) pattern.replace(at, place.size(), member);
  }
  return pattern;
}

/// The names of the layout's columns; for a layout without names the same number of empty ones.
std::vector<std::string> columns_of(const TableLayout& layout) {
  if (!layout.header) return std::vector<std::string>(layout.columns);
  std::vector<std::string> out;
  if (layout.time) out.push_back(layout.time->column.name);
  if (!layout.body.empty()) out.push_back(layout.body);
  const auto members = layout.names.empty() ? std::vector<std::string>{""} : layout.names;
  for (const std::string& member : members) {
    for (const FieldColumn& field : layout.fields) out.push_back(named(field.pattern, member));
  }
  return out;
}

/// A file of `rows` rows of ones, which are valid for any number and state; its stamps are after
/// 1970.
std::string file_of(const TableLayout& layout, int rows) {
  std::string text;
  for (std::size_t i = 0; i < layout.skip_lines; ++i) text += "a line of the recorder's\n";
  const auto columns = columns_of(layout);
  const std::string stamp = layout.time && layout.time->scale.epoch_s > 0 ? "63562205247984" : "1";
  const auto line = [&](auto&& cell) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      text += (c > 0 ? between(layout) : "") + cell(c);
    }
    text += "\n";
  };
  if (layout.header) line([&](std::size_t c) { return columns[c]; });
  for (int r = 0; r < rows; ++r) {
    line([&](std::size_t c) { return c == 0 ? stamp : "1"; });
  }
  return text;
}

struct FoundAs {
  std::string name, error;
};

FoundAs found(const std::string& text, const std::string& layout = "") {
  PosixFiles files;
  StreamOptions options;
  options.layout = layout;
  const auto format = find_format(files, options, {"recording.csv", ""}, text);
  return format ? FoundAs{format->name, ""} : FoundAs{"", to_string(format.error())};
}

}  // namespace

TEST_CASE("a file with just a layout's columns is found to be of that layout, and read by it") {
  for (const std::string_view name : builtin_layout_names()) {
    CAPTURE(name);
    const TableLayout layout = builtin(name);
    const std::string text = file_of(layout, 3);
    CHECK(matches(layout, text));
    CHECK(found(text).error == "");
    CHECK(found(text).name == name);
    CHECK(knows_columns(layout, text) == layout.header);
  }
}

TEST_CASE("a file whose rows are wrong is still of the layout that knows its columns") {
  for (const std::string_view name : builtin_layout_names()) {
    const TableLayout layout = builtin(name);
    if (!layout.header) continue;
    CAPTURE(name);
    const std::string text = file_of(layout, 1) + "no row of it\n";
    CHECK_FALSE(matches(layout, text));
    CHECK(knows_columns(layout, text));
    CHECK(found(text).name == name);
  }
}

TEST_CASE("every format and layout can be asked for by its name, and nothing else can") {
  for (const std::string_view name : format_names()) {
    CAPTURE(name);
    if (name == "ui_prmd_kinect" || name == "bids")
      continue;  // recognised by the file's name: see formats_test.cpp
    CHECK(found("", std::string(name)).name == name);
  }
  const std::string message = found("", "kinekt").error;
  CHECK(
      message.starts_with("recording.csv: expected a layout's path (*.toml) or one of bvh, trc, "
                          "c3d, mvnx, xsens, sto, ntu, "
                          "ui_prmd_kinect, bids, imu, "));
  CHECK(message.ends_with(", found 'kinekt'"));
  CHECK(found("", "there is none.toml").error ==
        "there is none.toml: expected a readable file, found No such file or directory");
}

TEST_CASE("every layout's joints have names that differ, and all states") {
  for (const std::string_view name : builtin_layout_names()) {
    CAPTURE(name);
    TableLayout layout = builtin(name);
    std::sort(layout.names.begin(), layout.names.end());
    CHECK(std::adjacent_find(layout.names.begin(), layout.names.end()) == layout.names.end());
    CHECK((layout.kind == TableKind::imu || !layout.names.empty()));
    for (const auto& values : {layout.state.missing, layout.state.inferred, layout.state.tracked}) {
      CHECK(!values.empty());
    }
    CHECK((layout.time.has_value() || layout.rate_hz > 0.0));  // each row has a time
  }
}
