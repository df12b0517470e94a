// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/table/row_selection.h"

#include "tests/formats/reading.h"

#include "kinalign/formats/table/table_reader.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

Read<PointReader> read_point(std::string_view toml, std::string_view text,
                             const StreamOptions& options = {}) {
  return read_all(make_point_table_reader(layout_of(toml), options, "p.csv"), text);
}

}  // namespace

TEST_CASE("rows are selected by a column, numbers by their value") {
  const std::string layout = std::string("name = 's'\nrate_hz = 1\n[joints]\nnames = ['A']\n") +
                             "fields = { x = 'x', y = 'y', z = 'z' }\n";
  const std::string text = "id,who,x,y,z\n1,ann,1,0,0\n2,bob,2,0,0\n01.0,bob,3,0,0\n";
  StreamOptions options;
  options.select = {{"id", "1"}};
  CHECK(read_point(layout, text, options).rows.positions == std::vector<double>{1, 0, 0, 3, 0, 0});
  options.select = {{"id", "1"}, {"who", "bob"}};
  CHECK(read_point(layout, text, options).rows.positions == std::vector<double>{3, 0, 0});
  options.select = {{"2", "bob"}};
  CHECK(read_point(layout, text, options).rows.size() == 2);
  options.select = {{"whom", "bob"}};
  CHECK(read_point(layout, text, options).error ==
        "p.csv:1: expected an existing column in select (nearest: who), found \"whom\"");
}

TEST_CASE("a wrong selection is reported with meaning and repair") {
  const std::string layout = std::string("name = 's'\nrate_hz = 1\nbody = 'id'\n[joints]\n") +
                             "names = ['A']\nfields = { x = 'x', y = 'y', z = 'z' }\n";
  const std::string text = "id,x,y,z\n7,1,0,0\n,2,0,0\n";
  StreamOptions options;
  options.select = {{"id", "9"}};
  const auto none = read_point(layout, text, options);
  REQUIRE(none.findings.size() == 1);
  CHECK(text_of(none.findings[0]) ==
        "p.csv: expected rows of id 9, found no such row; 2 rows of id 7, nothing");
  CHECK(none.findings[0].meaning == "the stream is empty");
  CHECK(none.findings[0].repair == "select existing values");
  const auto mixed = read_point(layout, text, {});
  REQUIRE(mixed.findings.size() == 1);
  CHECK(mixed.findings[0].severity == Severity::warning);
  CHECK(mixed.findings[0].meaning == "rows of several bodies are mixed in one stream");
}

TEST_CASE("a selection that takes no row is an error that names what is there") {
  const std::string layout = std::string("name = 's'\nrate_hz = 1\n[joints]\nnames = ['A']\n") +
                             "fields = { x = 'x', y = 'y', z = 'z' }\n";
  std::string text = "id,who,x,y,z\n1,ann,1,0,0\n2,bob,2,0,0\n2,bob,3,0,0\n";
  StreamOptions options;
  options.select = {{"id", "1"}, {"who", "bob"}};
  const auto read = read_point(layout, text, options);
  CHECK(read.error == "");
  REQUIRE(read.findings.size() == 1);
  CHECK(read.findings[0].severity == Severity::error);
  CHECK(text_of(read.findings[0]) ==
        "p.csv: expected rows of id 1, who bob, found no such row; 3 rows of id 1, 2, who ann, "
        "bob");
  for (int id = 3; id < 20; ++id) text += std::to_string(id) + ",eve,1,0,0\n";
  options.select = {{"id", "100"}};
  const auto many = read_point(layout, text, options);
  REQUIRE(many.findings.size() == 1);
  CHECK(text_of(many.findings[0]).ends_with("id 1, 2, 3, 4, 5, 6, 7, 8, ..."));
}

TEST_CASE("two bodies in one stream are a finding that proposes a selection") {
  const std::string layout = std::string("name = 's'\nrate_hz = 1\nbody = 'id'\n[joints]\n") +
                             "names = ['A']\nfields = { x = 'x', y = 'y', z = 'z' }\n";
  const std::string text = "id,x,y,z\n1,1,0,0\n2,2,0,0\n1,3,0,0\n";
  const auto mixed = read_point(layout, text, {});
  CHECK(mixed.rows.size() == 3);
  REQUIRE(mixed.findings.size() == 1);
  CHECK(text_of(mixed.findings[0]) ==
        "p.csv: expected one body in the selected rows, found id 1, 2");
  CHECK(mixed.findings[0].repair ==
        "select one body: select = { \"id\" = 1 } in the manifest, --select \"id=1\"");
  StreamOptions options;
  options.select = {{"id", "2"}};
  CHECK(read_point(layout, text, options).findings.empty());
  CHECK(read_point(layout, "x,y,z\n1,0,0\n", {}).findings.empty());  // there is no such column
}
