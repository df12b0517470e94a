// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/slimevr/packet.h"

#include "tests/about.h"
#include "tests/folder.h"
#include "tests/page_bytes.h"
#include "tests/protocols/slimevr/slimevr_bytes.h"
#include "tests/seeds.h"

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>

using namespace kinalign;

namespace {

SlimeDatagram decoded(const Bytes& bytes) {
  SlimeDatagram datagram;
  REQUIRE(decode_slime(bytes, datagram));
  return datagram;
}

template <class Packet>
Packet only(const Bytes& bytes) {
  const SlimeDatagram datagram = decoded(bytes);
  REQUIRE(datagram.packets.size() == 1);
  REQUIRE(std::holds_alternative<Packet>(datagram.packets[0]));
  return std::get<Packet>(datagram.packets[0]);
}

Bytes bytes_of(const SlimeAnswer& answer) {
  return {answer.datagram().begin(), answer.datagram().end()};
}

/// The folder into which ./dev test installs npm's packages; empty if @slimevr/firmware-protocol is
/// not there.
std::string node_modules() {
  const char* given = std::getenv("KINALIGN_NODE_MODULES");
  const std::string folder =
      given != nullptr ? given : KINALIGN_SOURCE_DIR "/build/npm/node_modules";
  const bool there = std::filesystem::exists(folder + "/@slimevr/firmware-protocol");
  return there ? folder : std::string();
}

Bytes from_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

std::string hex(const Bytes& bytes) {
  constexpr const char* digits = "0123456789abcdef";
  std::string out;
  for (const auto byte : bytes) out += {digits[byte >> 4], digits[byte & 15]};
  return out;
}

}  // namespace

TEST_CASE("the page's packets of trackers are what we read and send") {
  const auto page = [](const char* name) { return bytes_of_page("slimevr.md", name); };
  const auto motion = only<SlimeMotion>(page("rotation and acceleration"));
  CHECK(motion.sensor == 1);
  REQUIRE(motion.rotation);
  CHECK((*motion.rotation)[0] == 0.0F);
  CHECK((*motion.rotation)[2] == 23170.0F / 32768.0F);
  CHECK((*motion.rotation)[3] == 23170.0F / 32768.0F);
  CHECK(motion.acceleration == std::array<float, 3>{0.0F, 1.0F, 0.0F});
  const SlimeDatagram bundle = decoded(page("compact bundle"));
  CHECK(bundle.number == 257);
  REQUIRE(bundle.packets.size() == 2);
  CHECK(std::get<SlimeMotion>(bundle.packets[0]).acceleration == motion.acceleration);
  CHECK(std::holds_alternative<SlimeOther>(bundle.packets[1]));
  CHECK(bytes_of(slime_handshake_answer(0)) == page("handshake answer"));
}

TEST_CASE("the handshake's answer is what the tracker compares, as long as its handshake") {
  const std::string said = "\3Hey OVR =D 5";  // connection.cpp: byte 0, then 12 characters
  for (const std::size_t size : {12U, 13U, 40U, 64U, 200U}) {
    CAPTURE(size);
    const Bytes answer = bytes_of(slime_handshake_answer(size));
    CHECK(answer.size() == std::clamp<std::size_t>(size, 13, 64));
    CHECK(std::equal(said.begin(), said.end(), answer.begin()));
    CHECK(std::all_of(answer.begin() + 13, answer.end(), [](auto byte) { return byte == 0; }));
  }
}

TEST_CASE("what is sent to trackers has the bytes of their server") {
  CHECK(bytes_of(slime_heartbeat()) == Bytes{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0});
  CHECK(bytes_of(slime_ping(0x01020304)) == Bytes{0, 0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4});
  CHECK(bytes_of(slime_sensor_info_acknowledged(2, 1)) == Bytes{0, 0, 0, 15, 2, 1});
  CHECK(bytes_of(slime_features()) == Bytes{0, 0, 0, 22, 0, 0, 0, 0, 0, 0, 0, 0, 3});
}

TEST_CASE("firmware's handshake may end after any field, and what lacks is absent") {
  const Bytes whole = handshake_packet({});
  for (std::size_t size = 12; size <= whole.size(); ++size) {
    CAPTURE(size);
    const auto hands = only<SlimeHandshake>(Bytes(whole.begin(), whole.begin() + size));
    CHECK(hands.protocol == (size >= 40 ? std::optional(22) : std::nullopt));
    // Before the MAC: 1 + "0.7.0".
    CHECK(hands.mac ==
          (size >= 52 ? std::optional(SlimeMac{0xde, 0xad, 0xbe, 0xef, 0, 1}) : std::nullopt));
  }
}

TEST_CASE("a MAC of zeros is none, and a text beyond the end has no MAC after it") {
  Bytes bytes = handshake_packet({.mac = {}});
  CHECK(!only<SlimeHandshake>(bytes).mac);
  bytes = handshake_packet({});
  bytes[40] = 255;
  CHECK(!only<SlimeHandshake>(bytes).mac);
}

TEST_CASE("every packet of the table is known, and one byte less than is read is too short") {
  struct Row {
    std::uint32_t type;
    Bytes body;
    std::size_t least;
  };
  const Bytes one{0x3f, 0x80, 0, 0};
  const Bytes quaternion = joined({one, one, one, one}), vector = joined({one, one, one});
  const std::vector<Row> rows{{0, {}, 0},
                              {1, quaternion, 16},
                              {4, joined({vector, {2}}), 12},
                              {10, {1, 2, 3, 4}, 0},
                              {11, {0, 0, 0, 2, 'a', 'b'}, 0},
                              {12, one, 4},
                              {13, {1, 2}, 0},
                              {14, {1, 2}, 0},
                              {15, {1, 1}, 2},
                              {16, quaternion, 16},
                              {17, joined({{1, 1}, quaternion, {0}}), 19},
                              {18, joined({{1}, one}), 0},
                              {19, {255, 0xc4}, 0},
                              {20, joined({{1}, one}), 0},
                              {21, {3}, 0},
                              {22, {7}, 1},
                              {23, Bytes(15, 1), 15},
                              {24, {1, 0, 1}, 0},
                              {26, joined({{1}, one}), 0},
                              {27, joined({{1}, vector}), 0}};
  for (const Row& row : rows) {
    CAPTURE(row.type);
    Bytes bytes = slime_datagram(row.type, 5, row.body);
    CHECK(decoded(bytes).packets.size() == 1);
    CHECK(decoded(bytes).number == 5);
    bytes.push_back(0);  // a body that is longer than necessary
    CHECK(decoded(bytes).packets.size() == 1);
    if (row.least == 0) continue;
    bytes.resize(12 + row.least - 1);
    CHECK(decoded(bytes).packets.empty());
  }
  for (const std::uint32_t type : {2U, 5U, 25U, 28U, 105U, 200U, 0x01000011U}) {
    CHECK(decoded(slime_datagram(type, 1, Bytes(40))).packets.empty());
  }
}

TEST_CASE("values of packets stand where the table says") {
  const Bytes one{0x3f, 0x80, 0, 0}, two{0x40, 0, 0, 0}, half{0x3f, 0, 0, 0}, zero(4);
  const auto data =
      only<SlimeMotion>(slime_datagram(17, 1, joined({{3, 1}, one, two, half, zero, {9}})));
  CHECK(data.sensor == 3);
  CHECK(data.rotation == std::array<float, 4>{1.0F, 2.0F, 0.5F, 0.0F});
  CHECK(!data.acceleration);
  CHECK(!data.is_correction);
  CHECK(only<SlimeMotion>(slime_datagram(17, 1, joined({{3, 2}, one, two, half, zero, {9}})))
            .is_correction);
  CHECK(only<SlimeMotion>(slime_datagram(16, 1, joined({one, two, half, zero}))).sensor == 1);
  CHECK(only<SlimeMotion>(slime_datagram(1, 1, joined({one, two, half, zero}))).sensor == 0);
  const auto acceleration = only<SlimeMotion>(slime_datagram(4, 1, joined({one, two, half, {6}})));
  CHECK(acceleration.acceleration == std::array<float, 3>{1.0F, 2.0F, 0.5F});
  CHECK(acceleration.sensor == 6);
  CHECK(only<SlimeMotion>(slime_datagram(4, 1, joined({one, two, half}))).sensor == 0);
  const auto both = only<SlimeMotion>(
      slime_datagram(23, 1, {4, 0x80, 0, 0, 1, 0x7f, 0xff, 0, 0, 0xff, 0x80, 0, 64, 0, 0}));
  CHECK(both.rotation == std::array<float, 4>{-1.0F, 1.0F / 32768.0F, 32767.0F / 32768.0F, 0.0F});
  CHECK(both.acceleration == std::array<float, 3>{-1.0F, 0.5F, 0.0F});
  const auto battery = only<SlimeBattery>(slime_datagram(12, 1, joined({two, half})));
  CHECK(battery.volts == 2.0F);
  CHECK(!only<SlimeBattery>(slime_datagram(12, 1, half)).volts);
  const auto info = only<SlimeSensorInfo>(slime_datagram(15, 1, {2, 1, 4, 1, 2, 1, 5, 0}));
  CHECK(info.sensor == 2);
  CHECK(info.status == 1);
}

TEST_CASE("a bundle is its packets, in either form") {
  const Bytes quaternion(16, 0x3f);
  const Bytes rotation = joined({{1, 1}, quaternion, {0}});
  const Bytes wide = slime_datagram(
      100, 9, joined({{0, 23, 0, 0, 0, 17}, rotation, {0, 0}, {0, 6, 0, 0, 0, 13, 1, 1}}));
  const Bytes compact = slime_datagram(101, 9, joined({{20, 17}, rotation, {0}, {3, 13, 1, 1}}));
  for (const Bytes& bytes : {wide, compact}) {
    const SlimeDatagram datagram = decoded(bytes);
    REQUIRE(datagram.packets.size() == 2);
    CHECK(std::get<SlimeMotion>(datagram.packets[0]).sensor == 1);
    CHECK(std::holds_alternative<SlimeOther>(datagram.packets[1]));
  }
}

TEST_CASE("what is wrong in a bundle is left out, and the rest of it counts") {
  const auto packets = [](std::uint32_t type, const Bytes& body) {
    return decoded(slime_datagram(type, 1, body)).packets.size();
  };
  CHECK(packets(101, {1, 0, 2, 15, 1, 3, 13, 1, 1}) == 2);  // a sensor info without its status
  CHECK(packets(101, {3, 99, 0, 0, 1, 0}) == 1);
  CHECK(packets(101, {3, 101, 1, 0, 2, 100, 0}) == 0);
  CHECK(packets(101, {200, 13, 1, 1}) == 1);  // cut to the bytes that are there
  CHECK(packets(100, {0, 3, 0, 0, 0, 0, 4, 0, 0, 0, 0}) == 1);
  CHECK(packets(100, {0, 4, 0, 0, 0, 0, 7}) == 1);  // half of a length field
}

TEST_CASE("fewer than 12 bytes are no datagram of a tracker") {
  SlimeDatagram datagram;
  CHECK(!decode_slime(Bytes(11), datagram));
  CHECK(decode_slime(Bytes(12), datagram));
}

TEST_CASE("their z up is our y up") {
  // A sensor that lies like their world: its z points up, and in our world (0, 0, 1) turns to (0,
  // 1, 0).
  const double c = std::sqrt(0.5);
  const auto level = slime_orientation({0.0F, 0.0F, 0.0F, 1.0F});
  REQUIRE(level);
  CHECK((*level)[0] == about(c));
  CHECK((*level)[1] == about(-c));
  CHECK((*level)[2] == 0.0);
  CHECK((*level)[3] == 0.0);
  // A turn about their z is one about our y: (c, 0, c, 0) (c, -c, 0, 0) = (½, -½, ½, ½).
  // Quaternions of any length are accepted.
  const auto turned = slime_orientation({0.0F, 0.0F, 2.0F, 2.0F});
  REQUIRE(turned);
  CHECK((*turned)[0] == about(0.5));
  CHECK((*turned)[1] == about(-0.5));
  CHECK((*turned)[2] == about(0.5));
  CHECK((*turned)[3] == about(0.5));
}

TEST_CASE("any rotation is turned as a product of rotations says") {
  // -90 degrees about x, multiplied from the left; by Eigen's product.
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<float> normal;
    const std::array<float, 4> said{normal(random), normal(random), normal(random), normal(random)};
    const auto ours = slime_orientation(said);
    REQUIRE(ours);
    const Eigen::Quaterniond q(said[3], said[0], said[1], said[2]);
    const Eigen::Quaterniond wanted = turn * q.normalized();
    CHECK((*ours)[0] == doctest::Approx(wanted.w()));
    CHECK((*ours)[1] == doctest::Approx(wanted.x()));
    CHECK((*ours)[2] == doctest::Approx(wanted.y()));
    CHECK((*ours)[3] == doctest::Approx(wanted.z()));
  }
}

TEST_CASE("rotations and accelerations that are none") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  CHECK(!slime_orientation({0.0F, 0.0F, 0.0F, 0.0F}));
  CHECK(!slime_orientation({nan, 0.0F, 0.0F, 1.0F}));
  CHECK(!slime_orientation({infinite, 0.0F, 0.0F, 1.0F}));
  CHECK(!slime_acceleration({nan, 0.0F, 0.0F}, 22));
  CHECK(!slime_acceleration({0.0F, infinite, 0.0F}, 22));
  CHECK(!slime_acceleration({0.0F, 0.0F, -infinite}, 22));
}

TEST_CASE("acceleration before protocol 22 is turned by -90 degrees about z") {
  CHECK(slime_acceleration({1.0F, 2.0F, 3.0F}, 21) == std::array<double, 3>{2.0, -1.0, 3.0});
  CHECK(slime_acceleration({1.0F, 2.0F, 3.0F}, 0) == std::array<double, 3>{2.0, -1.0, 3.0});
  CHECK(slime_acceleration({1.0F, 2.0F, 3.0F}, 22) == std::array<double, 3>{1.0, 2.0, 3.0});
}

TEST_CASE("the project's own package reads what we send, and we what it sends" *
          doctest::description("needs the npm package @slimevr/firmware-protocol in build/npm") *
          doctest::skip(node_modules().empty())) {
  // Compared with npm's @slimevr/firmware-protocol 0.6.6.
  const FreshFolder folder;
  folder.write("given", hex(bytes_of(slime_handshake_answer(64))) + '\n' +
                            hex(bytes_of(slime_heartbeat())) + '\n' +
                            hex(bytes_of(slime_ping(1234567))) + '\n' +
                            hex(bytes_of(slime_features())) + '\n');
  const std::string command = "cd '" + folder.path() +
                              "' && node '" KINALIGN_SOURCE_DIR "/tests/witness/slimevr.mjs' '" +
                              node_modules() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  CHECK(folder.read("read") ==
        "DeviceBoundHandshakePacket{}\nDeviceBoundHeartbeatPacket{}\nDeviceBoundPingPacket{id: "
        "1234567}\n"
        "DeviceBoundFeatureFlagsPacket{flags: PROTOCOL_BUNDLE_SUPPORT}\n");
  CHECK(folder.read("acknowledged") == hex(bytes_of(slime_sensor_info_acknowledged(3, 1))));
  std::istringstream lines(folder.read("sent"));
  std::vector<SlimeDatagram> sent;
  for (std::string line; std::getline(lines, line);) sent.push_back(decoded(from_hex(line)));
  REQUIRE(sent.size() == 12);
  const auto packet = [&sent](std::size_t i) { return sent[i].packets.at(0); };
  const auto hands = std::get<SlimeHandshake>(packet(0));
  CHECK(hands.protocol == 17);
  CHECK(hands.mac == SlimeMac{1, 2, 3, 4, 5, 6});
  CHECK(std::holds_alternative<SlimeOther>(packet(1)));
  const auto rotation = std::get<SlimeMotion>(packet(2));
  CHECK(rotation.sensor == 2);
  CHECK(rotation.rotation == std::array<float, 4>{0.5F, -0.5F, 0.25F, 1.0F});
  CHECK(sent[2].number == 7);
  const auto acceleration = std::get<SlimeMotion>(packet(3));
  CHECK(acceleration.sensor == 1);
  CHECK(acceleration.acceleration == std::array<float, 3>{1.5F, -2.5F, 9.0F});
  CHECK(std::get<SlimeSensorInfo>(packet(4)).sensor == 4);
  CHECK(std::get<SlimeSensorInfo>(packet(4)).status == 1);
  CHECK(std::get<SlimeBattery>(packet(6)).volts == 3.75F);
  // A returned ping, the signal, the temperature, a tap and an error.
  for (const std::size_t i : {5U, 7U, 8U, 9U, 10U}) {
    CHECK(std::holds_alternative<SlimeOther>(packet(i)));
  }
  CHECK(std::holds_alternative<SlimeFeatures>(packet(11)));
}
