// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/table/table_reader.h"

#include "tests/formats/reading.h"

#include <doctest/doctest.h>

#include <numbers>
#include <string>

using namespace kinalign;

namespace {

constexpr const char* two_joints = R"(
name = "two"
kind = "points"
[time]
column = "t"
unit = "ms"
[joints]
names = ["ShoulderLeft", "ShoulderRight"]
fields = { x = "{joint}_x", y = "{joint}_y", z = "{joint}_z", state = "{joint}_state" }
)";

const std::string head =
    "t,ShoulderLeft_x,ShoulderLeft_y,ShoulderLeft_z,ShoulderLeft_state,ShoulderRight_x,"
    "ShoulderRight_y,ShoulderRight_z,ShoulderRight_state\n";

auto two_reader(StreamOptions options = {}) {
  return make_point_table_reader(layout_of(two_joints), options, "k.csv");
}

constexpr const char* one_point = R"(
name = "one"
header = false
rate_hz = 10
[joints]
names = ["A"]
fields = ["x", "y", "z"]
)";

Read<PointReader> read_point(std::string_view toml, std::string_view text,
                             const StreamOptions& options = {}) {
  return read_all(make_point_table_reader(layout_of(toml), options, "p.csv"), text);
}

}  // namespace

TEST_CASE("columns of a table are found by their names, wherever they stand") {
  const auto read = read_all(
      two_reader(),
      "note,ShoulderRight_z,ShoulderRight_y,ShoulderRight_x,ShoulderRight_state, ShoulderLeft_x,"
      "ShoulderLeft_y,ShoulderLeft_z,\"ShoulderLeft_state\",t\r\n"
      "hello, 6,5, 4 ,1,1,2,3,2,1500.25\r\n");
  CHECK(read.error == "");
  CHECK(read.header.joint_names == std::vector<std::string>{"ShoulderLeft", "ShoulderRight"});
  CHECK(read.rows.positions == std::vector<double>{1, 2, 3, 4, 5, 6});
  CHECK(read.rows.state == std::vector<Tracking>{Tracking::tracked, Tracking::inferred});
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(1'500'250'000)});
}

TEST_CASE("states may be absent, other columns may not") {
  CHECK(read_point(R"(
name = "one"
rate_hz = 10
[joints]
names = ["A"]
fields = { x = "{joint}_x", y = "{joint}_y", z = "{joint}_z", state = "{joint}_state" }
)",
                   "A_x,A_y,A_z\n1,2,3\n")
            .rows.state == std::vector<Tracking>{Tracking::tracked});
  CHECK(read_all(two_reader(), "t,ShoulderLeft_x\n").error ==
        "k.csv:1: expected a column ShoulderLeft_y, found no such column (nearest: "
        "ShoulderLeft_x)");
  CHECK(read_all(two_reader(), "t,t," + head).error ==
        "k.csv:1: expected one column t, found 3 with this name");
}

TEST_CASE("empty and nan cells, a state of 0 and the layout's missing point are missing joints") {
  const auto read = read_all(two_reader(), head +
                                               "1,,,,0,1,2,nan,2\n"
                                               "2,9,9,9,0,1,2,3,\n"
                                               "3,9,9,9,2,NaN,,-nan,2\n");
  CHECK(read.error == "");
  CHECK(read.rows.state == std::vector<Tracking>{Tracking::missing, Tracking::missing,
                                                 Tracking::missing, Tracking::missing,
                                                 Tracking::tracked, Tracking::missing});
  CHECK(read.rows.positions ==
        std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 9, 9, 0, 0, 0});
  const auto zero =
      read_point(std::string("missing_point = [0, 0, 0]\n") + one_point, "0,0,0\n0,0,1\n");
  CHECK(zero.rows.state == std::vector<Tracking>{Tracking::missing, Tracking::tracked});
}

TEST_CASE("a row of another shape is an error with its line") {
  CHECK(read_point(one_point, "1,2,3\n1,2\n1,2,3\n").error == "p.csv:2: expected 3 cells, found 2");
  CHECK(read_point(one_point, "1,2,3,4\n").error == "p.csv:1: expected 3 cells, found 4");
  CHECK(read_point(one_point, "1,2,3\n\n1,abc,3\n").error ==
        "p.csv:3: expected a number in column 2, found abc");
  CHECK(read_point(one_point, "1,2,inf\n").error ==
        "p.csv:1: expected a number in column 3, found inf");
  CHECK(read_point(one_point, "1,2,3e300\n").error ==
        "p.csv:1: expected a number in column 3, found 3e300");
  CHECK(read_all(two_reader(), head + "1,1,2,3,7,1,2,3,2\n").error ==
        "k.csv:2: expected a tracking state that the layout names, found 7");
}

TEST_CASE("a delimiter behind the last column is tolerated") {
  const auto read = read_point(one_point, "1,2,3,\n4,5,6,,\n");
  CHECK(read.error == "");
  CHECK(read.rows.positions == std::vector<double>{1, 2, 3, 4, 5, 6});
}

TEST_CASE("an incomplete last line is dropped with a finding") {
  const auto read = read_point(one_point, "1,2,3\n4,5");
  CHECK(read.error == "");
  CHECK(read.rows.size() == 1);
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) == "p.csv:2: expected 3 cells, found 2");
  CHECK(read.findings[0].meaning == "the last line is incomplete and was dropped");
  const auto unended = read_point(one_point, "1,2,3\n4,5,6");
  CHECK(unended.rows.size() == 2);
  REQUIRE(unended.findings.size() == 1);  // the 6 may have been 6.5 before the file was cut
  CHECK(unended.findings[0].severity == Severity::note);
  CHECK(text_of(unended.findings[0]) ==
        "p.csv:2: expected a line end after the last value, found the end of the file");
  CHECK(read_point(one_point, "1,2").error == "p.csv:1: expected 3 cells, found 2");
}

TEST_CASE("a table that ends in its head is an error") {
  CHECK(read_point(one_point, "").error ==
        "p.csv: expected a table of layout one, found the end of the file");
  CHECK(read_all(two_reader(), "\n\n").error ==
        "k.csv:2: expected a table of layout two, found the end of the file");
  CHECK(read_all(two_reader(), head).error == "");
}

TEST_CASE("rows without stamps come at the rate of the layout or of the options") {
  CHECK(read_point(one_point, "1,2,3\n1,2,3\n").rows.stamps ==
        std::vector<Time>{utc_time(0), utc_time(100'000'000)});
  StreamOptions options;
  options.rate_hz = 30;
  options.start_ns = 1000;
  CHECK(read_point(one_point, "1,2,3\n1,2,3\n1,2,3\n1,2,3\n", options).rows.stamps ==
        std::vector<Time>{utc_time(1000), utc_time(33'334'333), utc_time(66'667'667),
                          utc_time(100'001'000)});
  const std::string no_rate =
      "name = 'n'\nheader = false\n[joints]\nnames = ['A']\nfields = ['x','y','z']\n";
  CHECK(read_point(no_rate, "1,2,3\n").error ==
        "p.csv:1: expected rate_hz for rows without stamps, found none");
}

TEST_CASE("stamps are kept as they stand, repeated and backward ones too") {
  const auto read = read_all(two_reader(), head +
                                               "5,1,2,3,2,4,5,6,2\n5,1,2,3,2,4,5,6,2\n"
                                               "4,1,2,3,2,4,5,6,2\n");
  CHECK(read.rows.stamps ==
        std::vector<Time>{utc_time(5'000'000), utc_time(5'000'000), utc_time(4'000'000)});
  CHECK(read.findings.empty());
}

TEST_CASE("stamps that never move are a finding and give way to a rate") {
  std::string text = head;
  for (int i = 0; i < 40; ++i) text += "\"1,594038E+12\",1,2,3,2,4,5,6,2\n";
  const auto stuck = read_all(two_reader(), text);
  CHECK(stuck.error == "");
  REQUIRE(stuck.findings.size() == 1);
  CHECK(text_of(stuck.findings[0]) ==
        "k.csv: expected stamps that change, found the same stamp in the first 32 rows");
  CHECK(stuck.findings[0].repair == "set rate_hz to the rate of the device");
  CHECK(stuck.rows.stamps.back() == utc_time(1'594'038'000'000'000'000));
  StreamOptions options;
  options.rate_hz = 10;
  const auto by_rate = read_all(two_reader(options), text);
  REQUIRE(by_rate.rows.size() == 40);
  for (int i = 0; i < 40; ++i) {
    CHECK(to_ns(by_rate.rows.stamps[static_cast<std::size_t>(i)]) ==
          1'594'038'000'000'000'000 + i * 100'000'000LL);
  }
  check_pieces([&] { return two_reader(options); }, text.substr(0, 600));
}

TEST_CASE("a stamp outside the range of time is an error") {
  const std::string row = ",1,2,3,2,4,5,6,2\n";
  CHECK(read_all(two_reader(), head + "5e12" + row).error ==
        "k.csv:2: expected a stamp inside +-4e18 ns, found 5e12");
  CHECK(read_all(two_reader(), head + "99999999999999999999" + row).error ==
        "k.csv:2: expected a stamp inside +-4e18 ns, found 99999999999999999999");
  CHECK(read_all(two_reader(), head + row).error == "k.csv:2: expected a stamp inside +-4e18 ns");
  StreamOptions options;
  options.start_ns = 3'999'999'999'999'000'000;
  CHECK(read_all(two_reader(options), head + "1" + row + "5" + row).error ==
        "k.csv:3: expected a stamp inside +-4e18 ns, found 5000000 ns");
}

TEST_CASE("unit and axes are the layout's unless the user knows better") {
  const std::string layout = std::string("metres_per_unit = 0.001\nup = 'z'\n") + one_point;
  CHECK(read_point(layout, "1,2,3\n").rows.positions ==
        std::vector<double>{1 * 0.001, 3 * 0.001, -2 * 0.001});
  StreamOptions options;
  options.metres_per_unit = 2;
  options.up = "y";
  CHECK(read_point(layout, "1,2,3\n", options).rows.positions == std::vector<double>{2, 4, 6});
}

TEST_CASE("a mirrored Kinect file is a finding") {
  std::string text = head;
  for (int i = 0; i < 4; ++i) text += std::to_string(i) + ",1,0,2,2,-1,0,2,2\n";
  const auto read = read_all(two_reader(), text);
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) ==
        "k.csv: expected the left shoulder at smaller x than the right one, found the left "
        "shoulder at larger x in "
        "4 of 4 rows");
}

TEST_CASE("a sample of a node comes out in our world, its sensor's space untouched") {
  const auto read =
      read_all(make_imu_table_reader(layout_of(R"(
name = "g"
kind = "imu"
up = "z"
rate_hz = 100
acceleration_unit = "g"
angular_velocity_unit = "deg/s"
[nodes]
fields = { qw="w", qx="x", qy="y", qz="z", ax="ax", ay="ay", az="az", gx="gx", gy="gy", gz="gz" }
)"),
                                     {}, "data/waist.csv", ""),
               "w,x,y,z,ax,ay,az,gx,gy,gz\n2,0,0,0,0,0,1,180,0,0\n0,0,0,0,0,0,1,180,0,0\n");
  CHECK(read.error == "");
  CHECK(read.header.node_names == std::vector<std::string>{"waist"});
  CHECK(read.header.content == ImuContent{true, true, true, true});
  REQUIRE(read.rows.size() == 2);
  CHECK(read.rows.valid == std::vector<std::uint8_t>{1, 0});
  const Quat q = quat(read.rows.orientation, 0);
  CHECK((q * Vec3(0, 0, 1) - Vec3(0, 1, 0)).norm() < 1e-15);  // the file's up axis is ours
  CHECK(read.rows.acceleration == std::vector<double>{0, 0, 9.80665, 0, 0, 0});
  CHECK(read.rows.angular_velocity[0] == doctest::Approx(std::numbers::pi));
  CHECK(read.rows.orientation[4] == 0.0);
  REQUIRE(read.findings.size() == 2);
  CHECK(text_of(read.findings[0]) ==
        "data/waist.csv: expected quaternions of length 1, found 1 of 2 samples with length 0");
  CHECK(text_of(read.findings[1]) ==
        "data/waist.csv: expected quaternions of length 1, found 1 of 2 samples that differ by "
        "more than 2 %");
}

TEST_CASE("quantities whose columns are absent are absent") {
  const auto read = read_all(make_imu_table_reader(builtin("imu"), {}, "w.csv", "waist"),
                             "time_ns,gx,gy,gz\n1642700848752000001,1,2,3\n");
  CHECK(read.error == "");
  CHECK(read.header.node_names == std::vector<std::string>{"waist"});
  CHECK(read.header.content == ImuContent{false, false, true, true});
  CHECK(read.rows.orientation.empty());
  CHECK(read.rows.angular_velocity == std::vector<double>{1, 2, 3});
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(1'642'700'848'752'000'001)});
  CHECK(read_all(make_imu_table_reader(builtin("imu"), {}, "w.csv", "waist"), "time_ns,gx,gy\n")
            .error == "w.csv:1: expected a column gz, found no such column (nearest: gx)");
}

TEST_CASE("rows do not depend on where the file is cut into pieces") {
  check_pieces(
      [] { return two_reader(); },
      "\xef\xbb\xbf" + head + "1.5,1,2,3,2,4,5,6,1\r\n\r\n2.5,1e-2,,3,2,4,-5.25,6,0\r\n3,1");
  check_pieces(
      [] {
        return make_point_table_reader(
            layout_of(std::string("delimiter='blank'\ncomment='#'\n") + one_point), {}, "p.csv");
      },
      "# a comment\n 1 2  3 \n4\t5 6\n 1 2 3 4\n");
}

TEST_CASE("LSL-Kinect's confidences become states") {
  std::string text = "Software : LSL_Kinect,Version : 1.0.4.1,Stream nominal rate : 15\n\nTimeSpan";
  const TableLayout layout = builtin("lsl_kinect");
  for (const std::string& joint : layout.names) {
    text += "," + joint + "_X," + joint + "_Y," + joint + "_Z," + joint + "_Conf";
  }
  text += "\n1594038000123.25";
  for (std::size_t j = 0; j < 25; ++j)
    text += ",1,2,3," + std::string(j == 0 ? "0.5" : j == 1 ? "0" : "1");
  CHECK(matches(layout, text + "\n"));
  const auto read = read_all(make_point_table_reader(layout, {}, "lsl.csv"), text);
  CHECK(read.error == "");
  REQUIRE(read.rows.size() == 1);
  CHECK(read.rows.state[0] == Tracking::inferred);
  CHECK(read.rows.state[1] == Tracking::missing);
  CHECK(read.rows.state[2] == Tracking::tracked);
  CHECK(to_ns(read.rows.stamps[0]) == 1'594'038'000'123'250'000);
}

TEST_CASE("a column of a table from before UTF-8 is known by its name") {
  const TableLayout layout = layout_of(
      "name = \"mine\"\n[time]\ncolumn = \"t\"\n[joints]\nnames = [\"H\u00fcfte\"]\n"
      "fields = { x = \"{joint}_x\", y = \"{joint}_y\", z = \"{joint}_z\" }");
  for (const std::string name : {"H\xfc"
                                 "fte",
                                 "H\xc3\xbc"
                                 "fte"}) {
    const std::string head = "t," + name + "_x," + name + "_y," + name + "_z\n";
    CHECK(read_all(make_point_table_reader(layout, {}, "k.csv"), head + "1,1,2,3\n").error.empty());
  }
}

TEST_CASE("a column that a user's own layout names and the file lacks is noted") {
  const std::string text = "t,a_x,a_y,a_z,w_ax,w_ay,w_az\n1,1,2,3,4,5,6\n2,1,2,3,4,5,6\n";
  StreamOptions own;
  own.layout = "mine.toml";
  const auto noted = [&](auto reader) {
    const auto read = read_all(std::move(reader), text);
    return read.findings.empty() ? "" : text_of(read.findings[0]) + "; " + read.findings[0].meaning;
  };
  const TableLayout points = layout_of(
      "name = \"mine\"\n[time]\ncolumn = \"t\"\n[joints]\nnames = [\"a\"]\n"
      "fields = { x = \"{joint}_x\", y = \"{joint}_y\", z = \"{joint}_z\", state = "
      "\"{joint}_status\" }");
  CHECK(noted(make_point_table_reader(points, own, "k.csv")) ==
        "k.csv: expected a column a_status, as layout mine says, found no such column; every joint "
        "with a position counts as tracked");
  // Names of a built-in layout, with or without states.
  const std::string theirs = "t,a_x,a_y,a_z\n1,1,2,3\n2,1,2,3\n";
  CHECK(read_all(make_point_table_reader(points, {}, "k.csv"), theirs).findings.empty());
  const auto built_in = read_all(make_point_table_reader(points, {}, "k.csv"), text).findings;
  REQUIRE(built_in.size() == 1);  // unless it has another name
  CHECK(built_in[0].repair == "if it is one of the 3 unread columns, use its name in the layout");
  const TableLayout nodes = layout_of(
      "name = \"mine\"\nkind = \"imu\"\n[time]\ncolumn = \"t\"\n[nodes]\nnames = [\"w\"]\n"
      "fields = { ax = \"{node}_ax\", ay = \"{node}_ay\", az = \"{node}_az\", gx = \"{node}_gx\", "
      "gy = \"{node}_gy\", gz = \"{node}_gz\" }");
  CHECK(noted(make_imu_table_reader(nodes, own, "w.csv", "")) ==
        "w.csv: expected a column w_gx, as layout mine says, found no such column; this quantity "
        "is missing for all nodes");
}
