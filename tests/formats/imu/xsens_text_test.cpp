// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/imu/xsens_text.h"

#include "tests/formats/reading.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

using namespace kinalign;

namespace {

Read<ImuReader> read_xsens(std::string_view text, const StreamOptions& options = {}) {
  return read_all(make_xsens_text_reader(options, "MT_01_00B421E6.txt", ""), text);
}

const std::string rate = "// Update Rate: 100.0Hz\n";

/// A file whose rows have these packet counters.
Read<ImuReader> counters(const std::vector<std::uint64_t>& values) {
  std::string text = rate + "PacketCounter,Acc_X,Acc_Y,Acc_Z\n";
  for (const std::uint64_t value : values) text += std::to_string(value) + ",1,2,3\n";
  return read_xsens(text);
}

using Packets = std::vector<std::int64_t>;

/// The packet from which each row has its stamp.
Packets packets(const Read<ImuReader>& read) {
  Packets out;
  for (const Time stamp : read.rows.stamps) out.push_back(to_ns(stamp) / 10'000'000);
  return out;
}

/// The direction of a sensor's axis in our world.
Vec3 turned_axis(const Read<ImuReader>& read, const Vec3& axis) {
  return quat(read.rows.orientation, 0) * axis;
}

}  // namespace

TEST_CASE("an Xsens export gives a node's quantities and the counter's time") {
  const auto read = read_xsens(
      rate +
      "PacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z\tQuat_q0\tQuat_q1\t"
      "Quat_q2\tQuat_q3\n65534\t\t1\t2\t3\t4\t5\t6\t1\t0\t0\t0\n"
      "65535\t\t1\t2\t3\t4\t5\t6\t1\t0\t0\t0\n2\t\t\t2\t3\t4\t5\t6\t1\t0\t0\t0\n");
  CHECK(read.error == "");
  CHECK(read.header.node_names == std::vector<std::string>{"00B421E6"});
  CHECK(read.header.content == ImuContent{true, true, true, true});
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(655'340'000'000), utc_time(655'350'000'000),
                                              utc_time(655'380'000'000)});
  CHECK(read.rows.valid == std::vector<std::uint8_t>{1, 1, 0});
  CHECK((turned_axis(read, Vec3::UnitZ()) - Vec3::UnitY()).norm() < 1e-15);
  CHECK(read.rows.acceleration == std::vector<double>{1, 2, 3, 1, 2, 3, 0, 0, 0});
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) == "MT_01_00B421E6.txt: expected every packet, found 2 lost");
}

TEST_CASE("quaternion, matrix and angles of one orientation agree") {
  // Roll 10, pitch 20, yaw 30 degrees: R = Rz Ry Rx, the matrix column by column.
  const auto euler = read_xsens(rate + "PacketCounter;Roll;Pitch;Yaw\n1;10;20;30\n");
  const auto matrix = read_xsens(
      rate +
      "PacketCounter,Mat[1][1],Mat[2][1],Mat[3][1],Mat[1][2],Mat[2][2],Mat[3][2],Mat[1][3],"
      "Mat[2][3],Mat[3][3],Roll,Pitch,Yaw\n1,0.813797681,0.469846310,-0.342020143,-0.440969610,"
      "0.882564119,0.163175911,0.378522306,0.018028311,0.925416578,,,\n");
  const auto quaternion =
      read_xsens(rate +
                 "PacketCounter Quat_q0 Quat_q1 Quat_q2 Quat_q3\n1 0.951548525 0.038134576 "
                 "0.189307857 0.239298338\n");
  CHECK(matrix.error == "");
  REQUIRE(euler.rows.size() == 1);
  const Quat expected = quat(euler.rows.orientation, 0);
  CHECK(expected.angularDistance(quat(matrix.rows.orientation, 0)) < 1e-8);
  CHECK(expected.angularDistance(quat(quaternion.rows.orientation, 0)) < 1e-8);
}

TEST_CASE("free acceleration is brought into the sensor's space, without gravity") {
  // A quarter turn about the world's z: the world's x is the sensor's -y.
  const auto read = read_xsens(
      rate + "PacketCounter|FreeAcc_E|FreeAcc_N|FreeAcc_U|Roll|Pitch|Yaw\n1|3|0|1|0|0|90\n");
  CHECK(read.error == "");
  CHECK_FALSE(read.header.content.gravity);
  REQUIRE(read.rows.acceleration.size() == 3);
  CHECK((Vec3(read.rows.acceleration.data()) - Vec3(0, -3, 1)).norm() < 1e-15);
}

TEST_CASE("a named quantity that is empty is absent") {
  const auto read = read_xsens(rate +
                               "PacketCounter\tAcc_X\tAcc_Y\tAcc_Z\tRoll\tPitch\tYaw\n"
                               "1\t\t\t\t\t\t\n2\t1\t2\t3\t\t\t\n");
  CHECK(read.error == "");
  CHECK(read.header.content == ImuContent{false, true, false, true});
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(20'000'000)});
}

TEST_CASE("a quantity may begin within the first 32 rows; a later one is reported") {
  const auto with_gyr_from = [](int first) {
    std::string text = rate + "PacketCounter,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z\n";
    for (int row = 1; row <= 40; ++row) {
      text += std::to_string(row) + ",1,2,3," + (row < first ? ",,\n" : "4,5,6\n");
    }
    return read_xsens(text);
  };
  const auto soon = with_gyr_from(32);
  CHECK(soon.header.content == ImuContent{false, true, true, true});
  CHECK(soon.rows.stamps.size() == 40);
  CHECK(std::count(soon.rows.valid.begin(), soon.rows.valid.end(), 1) == 9);
  CHECK(soon.findings.empty());
  const auto late = with_gyr_from(33);
  CHECK(late.header.content == ImuContent{false, true, false, true});
  CHECK(late.rows.valid == std::vector<std::uint8_t>(40, 1));
  REQUIRE(late.findings.size() == 1);
  CHECK(text_of(late.findings[0]) ==
        "MT_01_00B421E6.txt: expected every quantity within the first 32 rows, found 8 rows with "
        "values that begin later: angular velocity");
}

TEST_CASE("rate and start are the user's where given") {
  const std::string text = "PacketCounter,Acc_X,Acc_Y,Acc_Z\n7,1,2,3\n9,1,2,3\n";
  CHECK(read_xsens(text).error ==
        "MT_01_00B421E6.txt:1: expected a line // Update Rate: ... above, or rate_hz, found none");
  StreamOptions options;
  options.rate_hz = 50;
  options.start_ns = 1'000'000'000;
  CHECK(read_xsens(rate + text, options).rows.stamps ==
        std::vector<Time>{utc_time(1'000'000'000), utc_time(1'040'000'000)});
}

TEST_CASE("an Xsens export that can't be understood is an error with its line") {
  CHECK(read_xsens("").error ==
        "MT_01_00B421E6.txt: expected rows of an Xsens export, found the end of the file");
  CHECK(read_xsens(rate + "Acc_X,Acc_Y\n").error ==
        "MT_01_00B421E6.txt:2: expected a column PacketCounter, found no such column");
  CHECK(read_xsens("// Update Rate: often\n").error ==
        "MT_01_00B421E6.txt:1: expected Update Rate: 100.0Hz, found // Update Rate: often");
  CHECK(read_xsens(rate + "PacketCounter,Roll,Pitch,Yaw\n1.5,1,2,3\n").error ==
        "MT_01_00B421E6.txt:3: expected a whole number as PacketCounter, found 1.500000");
  CHECK(read_xsens(rate + "PacketCounter,Roll,Pitch,Yaw\n1,1,2\n").error ==
        "MT_01_00B421E6.txt:3: expected 4 cells, found 3");
}

TEST_CASE("the node is the user's name, else the device's id, else the file's name") {
  struct Named {
    const char *file, *node, *expected;
  };
  const std::string text = rate + "PacketCounter,Roll,Pitch,Yaw\n1,0,0,0\n";
  for (const Named& one :
       {Named{"MT_01_00B421E6.txt", "waist", "waist"},
        Named{"a/MT_012005D6_009-001_00b421e6.txt", "", "00b421e6"},
        Named{"00B421E6.txt", "", "00B421E6"}, Named{"a.b/left_shank.txt", "", "left_shank"},
        Named{"MT_01_00B421EG.txt", "", "MT_01_00B421EG"}}) {
    CAPTURE(one.file);
    const auto read = read_all(make_xsens_text_reader({}, one.file, one.node), text);
    CHECK(read.header.node_names == std::vector<std::string>{one.expected});
  }
}

TEST_CASE("a packet counter of 16 bits counts on through its wraps, lost packets are gaps") {
  CHECK(packets(counters({65535, 0, 1})) == Packets{65535, 65536, 65537});
  CHECK(packets(counters({65530, 3, 64000})) == Packets{65530, 65539, 64000 + 65536});
  CHECK(packets(counters({70000, 70002})) == Packets{70000, 70002});  // packet counters of 32 bits
  const auto lost = counters({10, 11, 15, 16, 20});
  CHECK(packets(lost) == Packets{10, 11, 15, 16, 20});
  REQUIRE(lost.findings.size() == 1);
  CHECK(lost.findings[0].severity == Severity::note);
  CHECK(text_of(lost.findings[0]) == "MT_01_00B421E6.txt: expected every packet, found 6 lost");
  CHECK(lost.findings[0].meaning == "the missing packets are gaps");
  CHECK(counters({10, 11, 12}).findings.empty());
  // 12 arrived late and twice; 13 and 14 are lost.
  const auto twice = counters({10, 11, 15, 12, 12, 16});
  CHECK(text_of(twice.findings.at(0)) == "MT_01_00B421E6.txt: expected every packet, found 2 lost");
}

TEST_CASE("a packet out of order steps back, and later packets do not move") {
  const auto overtaken = counters({10, 11, 13, 12, 14});
  CHECK(packets(overtaken) == Packets{10, 11, 13, 12, 14});
  CHECK(overtaken.findings.empty());  // no packet was lost
  CHECK(packets(counters({65534, 0, 65535, 1})) == Packets{65534, 65536, 65535, 65537});
  // The counter began anew, and the finding says so.
  CHECK(packets(counters({2, 3, 0, 1})) == Packets{2, 3, 0, 1});
  const auto anew = counters({40000, 40001, 0, 1});
  CHECK(packets(anew) == Packets{40000, 40001, 65536, 65537});
  REQUIRE(anew.findings.size() == 2);
  CHECK(text_of(anew.findings[1]) ==
        "MT_01_00B421E6.txt: expected a rising PacketCounter, found a lower one, as if 25535 "
        "packets were lost");
}

TEST_CASE("one wild counter is one packet far ahead, and nothing behind it moves") {
  for (const std::uint64_t wild : {31 + 65536, 31 + (1 << 17), 31 + (1 << 30), 31 + 20000}) {
    CAPTURE(wild);
    const auto read = counters({29, 30, wild, 32, 33});
    const Packets found = packets(read);
    CHECK(found[2] == static_cast<std::int64_t>(wild));
    CHECK(found[3] == 32);
    CHECK(found[4] == 33);
    REQUIRE(read.findings.size() == 1);
    CHECK(text_of(read.findings[0]) == "MT_01_00B421E6.txt: expected every packet, found 1 lost");
  }
}

TEST_CASE("a first counter that is wild moves nothing behind it") {
  CHECK(packets(counters({1 << 20, 1, 2, 3})) == Packets{1 << 20, 1, 2, 3});
  CHECK(packets(counters({40000, 1001, 1002})) == Packets{40000, 1001, 1002});
  CHECK(packets(counters({1 << 20, 65535, 0, 1})) == Packets{1 << 20, 65535, 65536, 65537});
}

TEST_CASE("a packet may be late by up to a thousand packets, and a lasting loss is accepted") {
  CHECK(packets(counters({4999, 5000, 4000, 5001}))[2] == 4000);
  // The counter fell, so it began anew.
  CHECK(packets(counters({4999, 5000, 3999, 4000}))[2] == 3999 + 65536);
}

TEST_CASE("a counter of 32 bits that falls was restarted, whatever its lower 16 bits are") {
  const auto anew = counters({100'000, 131'078, 131'079, 3, 4, 5});
  const std::int64_t fall = (std::int64_t{1} << 32) - 131'076;
  CHECK(packets(anew).back() - packets(anew)[2] == fall + 2);
  REQUIRE(anew.findings.size() == 2);
  CHECK(anew.findings[1].what.found ==
        "a lower one, as if " + std::to_string(fall) + " packets were lost");
  CHECK(packets(counters({131'078, 131'080, 131'079, 131'081})) ==
        Packets{131'078, 131'080, 131'079, 131'081});
}

TEST_CASE("if a quantity is given in two forms, the form with more complete first rows is read") {
  std::string text = rate +
                     "PacketCounter,Acc_X,Acc_Y,Acc_Z,FreeAcc_X,FreeAcc_Y,FreeAcc_Z,"
                     "Quat_q0,Quat_q1,Quat_q2,Quat_q3,Roll,Pitch,Yaw\n";
  for (int row = 0; row < 40; ++row) {
    const bool stray = row == 4;
    text += std::to_string(row) + (stray ? ",1,1,1" : ",,,") + ",0,0,0" +
            (stray      ? ",1,0,0,0"
             : row == 5 ? ",1,,,"
                        : ",,,,") +
            ",0,0,90\n";
  }
  const auto read = read_xsens(text);
  CHECK(read.header.content == ImuContent{true, true, false, false});
  CHECK(std::count(read.rows.valid.begin(), read.rows.valid.end(), 1) == 40);
}

TEST_CASE("orientations are read from the quaternion, else the matrix, else the angles") {
  const std::string names =
      "PacketCounter,Roll,Pitch,Yaw,Mat[1][1],Mat[1][2],Mat[1][3],Mat[2][1],Mat[2][2],Mat[2][3],"
      "Mat[3][1],Mat[3][2],Mat[3][3],Quat_q0,Quat_q1,Quat_q2,Quat_q3\n";
  const std::string angles = "0,0,90", matrix = "-1,0,0,0,-1,0,0,0,1", none3 = ",,",
                    none9 = ",,,,,,,,", none4 = ",,,";
  StreamOptions options;
  options.up = "y";  // the option leaves the world's axes unchanged
  const auto x_goes = [&](const std::string& cells) {
    const auto read = read_xsens(rate + names + "1," + cells + "\n", options);
    REQUIRE(read.error == "");
    return turned_axis(read, Vec3::UnitX());
  };
  CHECK((x_goes(angles + "," + none9 + "," + none4) - Vec3::UnitY()).norm() < 1e-15);
  CHECK((x_goes(angles + "," + matrix + "," + none4) + Vec3::UnitX()).norm() < 1e-15);
  CHECK((x_goes(angles + "," + matrix + ",1,0,0,0") - Vec3::UnitX()).norm() < 1e-15);
  CHECK((x_goes(none3 + "," + matrix + "," + none4) + Vec3::UnitX()).norm() < 1e-15);
}

TEST_CASE("a sample that lost a part of what its first row had is not valid") {
  const auto read =
      read_xsens(rate +
                 "PacketCounter,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z,Roll,Pitch,Yaw\n"
                 "1,1,2,3,4,5,6,0,0,0\n2,1,,3,4,5,6,0,0,0\n3,1,2,3,4,5,,0,0,0\n4,1,2,3,4,5,6,0,,0\n"
                 "5,1,2,3,4,5,6,0,0,0\n");
  CHECK(read.error == "");
  CHECK(read.rows.valid == std::vector<std::uint8_t>{1, 0, 0, 0, 1});
  CHECK(read.rows.angular_velocity ==
        std::vector<double>{4, 5, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 5, 6});
}

TEST_CASE("a row without its counter, a line of no names and an odd rate are refused") {
  const std::string names = "PacketCounter,Roll,Pitch,Yaw\n";
  const std::string file = "MT_01_00B421E6.txt:";
  const std::vector<std::array<std::string, 2>> refused{
      {rate + names + ",1,2,3\n",
       "3: expected a whole number as PacketCounter, found an empty cell"},
      {rate + names + "-1,1,2,3\n", "3: expected a whole number as PacketCounter, found -1.000000"},
      {rate + names + "4294967296,1,2,3\n",
       "3: expected a whole number as PacketCounter, found 4294967296.000000"},
      {rate + names + "1,a,2,3\n", "3: expected a number in column 2, found a"},
      {rate + "PacketCounter\n", "2: expected names of columns, found PacketCounter"},
      {"// Update Rate: 0Hz\n", "1: expected Update Rate: 100.0Hz, found // Update Rate: 0Hz"},
      {"// Update Rate: 1e7Hz\n", "1: expected Update Rate: 100.0Hz, found // Update Rate: 1e7Hz"},
      {"// Update Rate:\n", "1: expected Update Rate: 100.0Hz, found // Update Rate:"}};
  for (const auto& [text, message] : refused) {
    CAPTURE(text);
    CHECK(read_xsens(text).error == file + message);
  }
  StreamOptions slow;
  slow.rate_hz = 1e-3;
  CHECK(read_xsens(names + "4294967295,1,2,3\n", slow).error ==
        file + "2: expected a stamp inside +-4e18 ns, found 4294967295 packets");
}

TEST_CASE("rows of an Xsens export do not depend on where it is cut into pieces") {
  check_pieces([] { return make_xsens_text_reader({}, "x", "waist"); },
               rate + "PacketCounter;Year;Roll;Pitch;Yaw\r\n00001;;1;2;3\r\n00003;;;2;3\r\n4;;1;2");
}

TEST_CASE("Xsens exports of every delimiter are read" * doctest::skip(!shared_data())) {
  struct Expected {
    const char* file;
    std::size_t rows;
    ImuContent content;
  };
  constexpr ImuContent all{true, true, true, true};
  constexpr ImuContent no_gyro{true, true, false, true};
  for (const Expected& expected :
       {Expected{"MT2022_ACC_00B42D4B.txt", 5, {false, true, false, true}},
        {"MT2022_ACC_GYRO_ROT_ALL_TAB_NAN_00B42D4B.txt", 5, all},
        {"MT2022_ACC_GYRO_ROT_EULER_TAB_00B42D4F.txt", 5, all},
        {"MT2022_ACC_GYRO_ROT_MAT_COMMA_00B42D4B.txt", 5, all},
        {"MT2022_ACC_GYRO_ROT_MAT_SEMICOLON_00B42D4B.txt", 5, all},
        {"MT2022_ACC_GYRO_ROT_MAT_SPACE_00B42D4B.txt", 5, all},
        {"MT46_01-000_00B42D4D.txt", 5, all},
        {"MT_01200312-002-000_00B474BA.txt", 5, no_gyro},
        {"MT_01200454_000-000_00B40DE4.txt", 4, all},
        {"MT_012005D6-000_sit_to_stand-000_00B421ED.txt", 1459, {true, false, false, true}},
        {"MT_012005D6_009-001_00B421E6.txt", 2432, no_gyro},
        {"MT_012005D6_009-001_00B421ED.txt", 2481, no_gyro},
        {"test1_00B421E6.txt", 3, all}}) {
    CAPTURE(expected.file);
    const std::string text = shared_text(std::string("imu_opensim/xsens/") + expected.file);
    CHECK(looks_like_xsens_text(text.substr(0, 4096)));
    StreamOptions options;
    options.rate_hz = 100;
    const auto read =
        read_in_pieces(make_xsens_text_reader(options, expected.file, ""), text, 4096);
    CHECK(read.error == "");
    CHECK(read.rows.size() == expected.rows);
    CHECK(read.header.content == expected.content);
    CHECK(read.header.node_names[0].size() == 8);
  }
}

TEST_CASE("gravity points up in a walk's raw Xsens export" * doctest::skip(!shared_data())) {
  const std::string path = "imu_pose/unsw_walk/rawimu/S02-Trial-Walk-1-000_00B40B91.txt";
  const auto read = read_all(make_xsens_text_reader({}, path, ""), shared_text(path));
  CHECK(read.error == "");
  REQUIRE(read.rows.size() == 2503);
  CHECK(read.findings.empty());
  CHECK(to_ns(read.rows.stamps[0]) == 276'260'000'000);  // packet 27626
  Vec3 sum = Vec3::Zero();
  for (std::size_t t = 1119; t < 1119 + 955; ++t) {
    sum += quat(read.rows.orientation, t) *
           Vec3(vec3(std::span<const double>(read.rows.acceleration), t));
  }
  CHECK((sum / 955 - Vec3(0.06, 9.90, 0.09)).norm() < 0.01);
}
