// SPDX-License-Identifier: Apache-2.0
// Values that a layout may not have, key by key; and the columns that a file must have for a
// layout.
#include "tests/formats/reading.h"

#include "kinalign/formats/table/table_reader.h"

#include <doctest/doctest.h>

#include <array>

using namespace kinalign;

namespace {

using Refused = std::vector<std::array<std::string, 2>>;

std::string fault_of(const std::string& toml) {
  const auto layout = parse_layout(toml, "odd.toml");
  return layout ? "none" : to_string(layout.error());
}

const std::string joints = "[joints]\nnames = ['A']\nfields = ['x', 'y', 'z']\n";

/// Checks keys in front of a sound layout of points; the keys begin on line 2.
void check_keys(const Refused& refused) {
  for (const auto& [keys, message] : refused) {
    CAPTURE(keys);
    CHECK(fault_of("name = 'a'\n" + keys + "\n" + joints) == "odd.toml:" + message);
  }
}

std::string fault_of_file(const std::string& toml, std::string_view text) {
  return read_all(make_point_table_reader(layout_of(toml), {}, "p.csv"), text).error;
}

}  // namespace

TEST_CASE("what stands where a text, a number or a choice is wanted is refused with its line") {
  check_keys({
      {"kind = 'force'", "2: expected kind as one of points, imu, found \"force\""},
      {"kind = true", "2: expected kind as one of points, imu, found true"},
      {"delimiter = ','",
       "2: expected delimiter as one of comma, semicolon, tab, blank, found \",\""},
      {"comment = ['#']", "2: expected comment as a text, found a list"},
      {"header = 'no'", "2: expected header as true or false, found \"no\""},
      {"skip_lines = 1.5", "2: expected skip_lines as a whole number from 0 to 100000, found 1.5"},
      {"columns = 100001", "2: expected columns as a whole number from 0 to 100000, found 100001"},
      {"rate_hz = 0", "2: expected rate_hz as a number from 1e-09 to 1000000000, found 0"},
      {"rate_hz = 'fast'",
       "2: expected rate_hz as a number from 1e-09 to 1000000000, found \"fast\""},
      {"rate_hz = inf", "2: expected rate_hz as a number from 1e-09 to 1000000000, found inf"},
      {"rate_hz = nan", "2: expected rate_hz as a number from 1e-09 to 1000000000, found nan"},
      {"metres_per_unit = 2e9",
       "2: expected metres_per_unit as a number from 1e-09 to 1000000000, found 2000000000"},
      {"up = 'x'", "2: expected up as one of y, z, found \"x\""},
      {"acceleration_unit = 'mg'", "2: expected acceleration_unit as one of m/s2, g, found \"mg\""},
      {"angular_velocity_unit = 'rpm'",
       "2: expected angular_velocity_unit as one of rad/s, deg/s, found \"rpm\""},
      {"gravity = 9.81", "2: expected gravity as true or false, found 9.81"},
      {"missing_point = [0, 0]",
       "2: expected missing_point as a list of 3 numbers, found 2 numbers"},
      {"missing_point = 'none'",
       "2: expected missing_point as a list of 3 numbers, found \"none\""},
      {"missing_point = [0, 0, nan]",
       "2: expected missing_point as a list of 3 numbers, found nan"},
      {"body = [1]", "2: expected body as a text, found a list"},
      {"select = 3", "2: expected select as a table, found 3"},
      {"select = { id = [1] }", "2: expected id as a text, found a list"},
  });
}

TEST_CASE("time, states and axes of a layout are tables of known keys and values") {
  check_keys({
      {"time = 't'", "2: expected time as a table, found \"t\""},
      {"[time]\ncolumn = 't'\nunits = 'ms'",
       "4: expected a key of [time] (nearest: unit), found \"units\""},
      {"[time]\ncolumn = 0", "3: expected column as a whole number from 1 to 100000, found 0"},
      {"[time]\ncolumn = -1", "3: expected column as a whole number from 1 to 100000, found -1"},
      {"[time]\ncolumn = 't'\nunit = 'h'",
       "4: expected unit as one of ns, us, ms, s, ticks_100ns, found \"h\""},
      {"[time]\ncolumn = 't'\nepoch = 'gps'",
       "4: expected epoch as one of unix, year_1, found \"gps\""},
      {"[state]\nmissing = 0\ninferred = 1\ntracked = ['2']",
       "5: expected tracked as a number or a list of numbers, found \"2\""},
      {"[state]\nlost = 0",
       "3: expected a key of [state] (known: missing, inferred, tracked), found \"lost\""},
      {"[axes]\nx = 'left'", "3: expected x as one of x, y, z, -x, -y, -z, found \"left\""},
      {"[axes]\nw = 'x'", "3: expected a key of [axes] (nearest: x), found \"w\""},
      {"[axes]\nmirrored = true", "2: expected axes that mirror, found right-handed axes"},
  });
}

TEST_CASE("joints and their fields must be complete") {
  const Refused refused{
      {"joints = ['A']\n", "2: expected joints as a table, found a list"},
      {"[joints]\nfields = ['x', 'y', 'z']\n", "2: expected names in [joints], found none"},
      {"[joints]\nnames = ['A', 3]\nfields = ['x', 'y', 'z']\n",
       "3: expected names as a list of texts, found a list"},
      {"[joints]\nnames = ['A']\n", "2: expected fields in [joints], found none"},
      {"[joints]\nnames = ['A']\nfields = { x = 'x', y = 'y' }\n",
       "4: expected all components of a quantity, found 2 of 3"},
      {"[joints]\nnames = ['A']\nfields = { x = ['x'], y = 'y', z = 'z' }\n",
       "4: expected x as a text, found a list"},
      {"[joints]\nnames = ['A']\nfields = ['x', 'y', 'z']\nfirst_column = 0\n",
       "1: expected at least 2 columns, found 0"},
      {"header = false\n[joints]\nnames = ['A']\nfields = { x = 'x', y = 'y', z = 'z' }\n",
       "1: expected a list of fields, because no line names the columns, found fields by name"},
      {"kind = 'imu'\n" + joints, "1: expected a table [nodes], found none"},
      {"kind = 'imu'\n[nodes]\nfields = ['x', 'y', 'z']\n",
       "4: expected fields qw ... qz, ax ... az, gx ... gz, skip, found x"},
      {"kind = 'imu'\n[nodes]\nfields = ['qw', 'qx', 'qy']\n",
       "4: expected all components of a quantity, found 3 of 4"},
      {"kind = 'imu'\n[nodes]\nfields = { gravity = 'g' }\n",
       "4: expected fields qw ... qz, ax ... az, gx ... gz, skip, found gravity"}};
  for (const auto& [text, message] : refused) {
    CAPTURE(text);
    CHECK(fault_of("name = 'a'\n" + text) == "odd.toml:" + message);
  }
}

TEST_CASE("a file has the columns that its layout names, each once, each with one meaning") {
  const std::string by_name =
      "name = 'n'\nrate_hz = 1\n[joints]\nnames = ['A']\nfields = { x = 'u', y = 'v', z = '";
  CHECK(fault_of_file(by_name + "w' }\n", "u,v,w\n1,2,3\n") == "");
  CHECK(fault_of_file(by_name + "w' }\n", "u,v\n1,2\n") ==
        "p.csv:1: expected a column w, found no such column (nearest: u)");
  CHECK(fault_of_file(by_name + "w' }\n", "u,v,w,w\n1,2,3,4\n") ==
        "p.csv:1: expected one column w, found 2 with this name");
  CHECK(fault_of_file(by_name + "u' }\n", "u,v\n1,2\n") ==
        "p.csv:1: expected one use of column 1, found two");
  const std::string numbered =
      "name = 'n'\nheader = false\ncolumns = 4\n[time]\ncolumn = 9\n" + joints;
  CHECK(fault_of_file(numbered, "1,2,3,4\n") == "p.csv:1: expected a column 9, found 4 columns");
}

TEST_CASE("a table of nodes without any quantity of its layout is none") {
  const auto read = read_all(make_imu_table_reader(builtin("imu"), {}, "w.csv", "waist"),
                             "time_ns,temperature\n1,20\n");
  CHECK(read.error == "w.csv:1: expected columns of layout imu, found none");
}

TEST_CASE("first_column and skip leave out what a table holds besides") {
  const auto read = read_all(
      make_point_table_reader(
          layout_of("name = 'n'\nheader = false\nrate_hz = 1\n[joints]\nnames = ['A', 'B']\n"
                    "fields = ['skip', 'x', 'y', 'z']\nfirst_column = 3\n"),
          {}, "p.csv"),
      "id,note,far,1,2,3,near,4,5,6\n");
  CHECK(read.error == "");
  CHECK(read.rows.positions == std::vector<double>{1, 2, 3, 4, 5, 6});
}

TEST_CASE("a layout's own selection is used if the user gives none for that column") {
  const std::string toml =
      "name = 'n'\nrate_hz = 1\n[select]\nid = 1\n[joints]\nnames = ['A']\n"
      "fields = { x = 'x', y = 'y', z = 'z' }\n";
  const std::string text = "id,x,y,z\n1,1,0,0\n2,2,0,0\n";
  const auto taken = [&](const StreamOptions& options) {
    return read_all(make_point_table_reader(layout_of(toml), options, "p.csv"), text)
        .rows.positions;
  };
  CHECK(taken({}) == std::vector<double>{1, 0, 0});
  StreamOptions options;
  options.select = {{"id", "2"}};
  CHECK(taken(options) == std::vector<double>{2, 0, 0});
}

TEST_CASE("comments and skipped lines are no rows, wherever they stand") {
  const auto read = read_all(
      make_point_table_reader(layout_of("name = 'n'\nheader = false\nrate_hz = 1\ncomment = '//'\n"
                                        "skip_lines = 2\n" +
                                        joints),
                              {}, "p.csv"),
      "a log, of\n9,9,9\n// 8,8,8\n1,2,3\n// the end\n4,5,6\n");
  CHECK(read.error == "");
  CHECK(read.rows.positions == std::vector<double>{1, 2, 3, 4, 5, 6});
}
