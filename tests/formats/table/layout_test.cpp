// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/table/layout.h"

#include "tests/formats/reading.h"

#include <doctest/doctest.h>

#include <numbers>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

std::string fault_of(std::string_view toml) {
  const auto layout = parse_layout(toml, "odd.toml");
  return layout ? "none" : to_string(layout.error());
}

const std::string members = "[joints]\nnames = [\"A\"]\nfields = [\"x\", \"y\", \"z\"]\n";

}  // namespace

TEST_CASE("a layout describes a table of points completely") {
  const TableLayout layout = layout_of(R"(
name = "lab"
kind = "points"
delimiter = "semicolon"
comment = "#"
skip_lines = 2
metres_per_unit = 0.001
missing_point = [0, 0, 0]
[time]
column = "t"
unit = "ms"
epoch = "year_1"
[joints]
names = ["A", "B"]
fields = { x = "{joint}.x", y = "{joint}.y", z = "{joint}.z", state = "{joint}.s" }
[state]
missing = 0
inferred = 1
tracked = [2, 3]
[axes]
x = "x"
y = "z"
z = "-y"
[select]
body = 3
)");
  CHECK(layout.kind == TableKind::points);
  CHECK(layout.delimiter == ';');
  CHECK(layout.comment == "#");
  CHECK(layout.skip_lines == 2);
  CHECK(layout.header);
  REQUIRE(layout.time);
  CHECK(layout.time->column.name == "t");
  CHECK(layout.time->scale.unit_ns == 1'000'000);
  CHECK(layout.time->scale.epoch_s == year_1_s);
  CHECK(layout.names == std::vector<std::string>{"A", "B"});
  CHECK(layout.fields.size() == 4);
  CHECK(layout.axes == z_up);
  CHECK(layout.state.tracked == std::vector<double>{2, 3});
  CHECK(layout.missing_point.size() == 3);
  CHECK(layout.select.at("body") == "3");
}

TEST_CASE("a layout of nodes has units of its own") {
  const TableLayout layout = layout_of(R"(
name = "limb"
kind = "imu"
up = "z"
gravity = false
acceleration_unit = "g"
angular_velocity_unit = "deg/s"
rate_hz = 200
header = false
[nodes]
fields = ["ax", "ay", "az", "gx", "gy", "gz", "skip"]
)");
  CHECK(layout.columns == 7);
  CHECK(layout.acceleration_unit == doctest::Approx(9.80665));
  CHECK(layout.angular_velocity_unit == doctest::Approx(std::numbers::pi / 180));
  CHECK_FALSE(layout.gravity);
  CHECK(layout.axes == z_up);
}

TEST_CASE("a state without values is stated by an empty list, not by the usual value") {
  const TableLayout layout = layout_of("name = 'a'\n" + members +
                                       "[state]\nmissing = [0, 1]\ninferred = []\ntracked = 2\n");
  CHECK(layout.state.missing == std::vector<double>{0, 1});
  CHECK(layout.state.inferred.empty());
  CHECK(layout.state.tracked == std::vector<double>{2});
}

TEST_CASE("an error in a layout names line, what is possible and what stands there") {
  CHECK(fault_of("name = 'a'\ndelimiter = 'colon'\n" + members) ==
        "odd.toml:2: expected delimiter as one of comma, semicolon, tab, blank, found \"colon\"");
  CHECK(fault_of("name = 'a'\nrate_hz = -3\n" + members) ==
        "odd.toml:2: expected rate_hz as a number from 1e-09 to 1000000000, found -3");
  CHECK(fault_of("name = 'a'\nheader = 1\n" + members) ==
        "odd.toml:2: expected header as true or false, found 1");
  CHECK(fault_of("name = 'a'\nskip_lines = -1\n" + members) ==
        "odd.toml:2: expected skip_lines as a whole number from 0 to 100000, found -1");
  CHECK(fault_of("name = 'a'\n") == "odd.toml:1: expected a table [joints], found none");
  CHECK(fault_of("name = 'a'\n[joints]\nnames = []\nfields = ['x']\n") ==
        "odd.toml:2: expected names in [joints], found none");
  CHECK(fault_of(members) == "odd.toml:1: expected name, what the layout is called, found none");
  CHECK(fault_of("name = 'a'\n[time]\nunit = 'ms'\n" + members) ==
        "odd.toml:2: expected column in [time], a name or a number from 1, found none");
}

TEST_CASE("an unknown key in a layout is an error at its line") {
  CHECK(fault_of("name = 'a'\n[joints]\nnames = ['A']\nfields = ['x', 'y', 'z']\norder = 1\n") ==
        "odd.toml:5: expected a key of [joints] (known: fields, names, first_column), found "
        "\"order\"");
  const std::string top = fault_of("name = 'a'\ncolour = 'red'\n" + members);
  CHECK(top.starts_with("odd.toml:2: expected a known key (known: axes, joints, "));
  CHECK(top.ends_with(", found \"colour\""));
}

TEST_CASE("what is no TOML is an error at its line") {
  CHECK(fault_of("name = 'a'\nkind = \n").starts_with("odd.toml:2: expected TOML, found "));
}

TEST_CASE("a layout whose axes mirror has to say so") {
  const std::string axes = "name = 'a'\n" + members + "[axes]\nx = '-x'\n";
  CHECK(fault_of(axes) ==
        "odd.toml:5: expected right-handed axes, found a mirror image without mirrored = "
        "true");
  CHECK(fault_of(axes + "mirrored = true\n") == "none");
  CHECK(fault_of("name = 'a'\n" + members + "[axes]\nx = 'y'\n") ==
        "odd.toml:5: expected right-handed axes, found one axis twice");
}

TEST_CASE("a layout of nodes has no mirror image") {
  const std::string nodes = "name = 'a'\nkind = 'imu'\n[nodes]\nfields = ['ax', 'ay', 'az']\n";
  CHECK(fault_of(nodes + "[axes]\nx = '-x'\nmirrored = true\n") ==
        "odd.toml:7: expected right-handed axes for nodes, because an orientation has no mirror "
        "image, found mirrored = true");
  CHECK(fault_of(nodes + "[axes]\nx = 'z'\nz = '-x'\nmirrored = false\n") == "none");
}

TEST_CASE("a quantity stands in a layout with all its components, each once") {
  const std::string begin = "name = 'a'\nheader = false\n[joints]\nnames = ['A']\n";
  CHECK(fault_of(begin + "fields = ['x', 'z']\n") ==
        "odd.toml:5: expected all components of a quantity, found 2 of 3");
  CHECK(fault_of(begin + "fields = ['x', 'y', 'z', 'z']\n") ==
        "odd.toml:5: expected each field once, found one twice");
  CHECK(fault_of(begin + "fields = ['x', 'y', 'qw']\n") ==
        "odd.toml:5: expected fields x, y, z, state, skip, found qw");
  CHECK(fault_of(begin + "fields = ['skip']\n") ==
        "odd.toml:5: expected x, y and z, or a quantity of an IMU, found none");
}

TEST_CASE("a table whose columns have no names is declared by numbers") {
  CHECK(fault_of("name = 'a'\nheader = false\n[time]\ncolumn = 't'\n" + members) ==
        "odd.toml:3: expected a column's number, because no line names the columns, found t");
  CHECK(fault_of("name = 'a'\nheader = false\ncolumns = 2\n" + members) ==
        "odd.toml:3: expected at least 3 columns, found 2");
}

TEST_CASE("every layout that the program carries is understood") {
  CHECK(builtin_layout_names().size() >= 11);
  for (const std::string_view name : builtin_layout_names()) {
    CAPTURE(name);
    CHECK(builtin(name).name == name);
  }
  CHECK_FALSE(builtin_layout("no such layout"));
}
