// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record_text.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

/// A lab a minute after its ports were opened: mocap at work, one of two nodes, a silent Kinect.
struct Scene {
  Lab lab;
  LabStatus status;

  Scene() {
    lab.devices = {*parse_device("mocap=noitom:7012"), *parse_device("kinect=kinect:7201"),
                   *parse_device("imu=nodes:5005")};
    lab.devices[0].rate_hz = 125;
    lab.devices[2].nodes = {{"7", "waist"}, {"12", "wrist"}};
    status.begun = HostTime{100s};
    status.now = HostTime{160s};
    StreamStatus mocap;
    mocap.stream = "mocap";
    mocap.sender = "192.168.7.5:51234";
    mocap.counts.messages = 7500;
    mocap.counts.bytes = 11'100'000;
    mocap.counts.order.lost = 3;
    mocap.rate_hz = 124.9;
    mocap.heard = HostTime{159900ms};
    StreamStatus kinect = mocap;
    kinect.stream = "kinect";
    kinect.heard = HostTime{150s};
    kinect.rate_hz = 0;
    StreamStatus node = mocap;
    node.stream = "imu";
    node.node = "7";
    node.place = "waist";
    node.battery_volts = 3.7;
    status.streams = {mocap, kinect, node};
    NodeStatus clock;
    clock.node_id = 7;
    clock.n = NodeTime{1160s};
    clock.drift = 20.1e-6;
    clock.stamp = ClockStamp{};
    clock.stamp->time = HostTime{160s};
    clock.stamp->earliest = HostTime{160s - 1040us};
    clock.stamp->latest = HostTime{160s + 1040us};
    clock.stamp->certainty = Certainty::certified;
    status.nodes = {clock};
  }
};

}  // namespace

TEST_CASE("a lab's table has a line for each sender, and one for each device that lacks") {
  const Scene scene;
  const auto lines = lab_table(scene.lab, scene.status);
  REQUIRE(lines.size() == 5);
  CHECK(lines[0].text ==
        "device                   rate/s    lost  late twice    heard                  clock     "
        "ppm battery  recorded");
  CHECK(
      lines[1].text ==
      "mocap              124.9 of 125       3     0     0    0.1 s                                "
      "         11.1 MB  udp 192.168.7.5:51234");
  CHECK(!lines[1].bad);
  CHECK(lines[2].text.starts_with("kinect                0.0 of 30       3     0     0   10.0 s"));
  CHECK(lines[2].bad);
  CHECK(lines[3].text ==
        "imu waist                 124.9       3     0     0    0.1 s -1000.0000 s ± 1.04 ms   "
        "+20.1  3.70 V  11.1 MB  udp 192.168.7.5:51234");
  CHECK(lines[4].text == "imu wrist          nothing yet, 60 s");
  CHECK(lines[4].bad);
}

TEST_CASE("what a port lost stands red below its device, required or not") {
  Scene scene;
  scene.lab.devices[0].required = false;
  PortCounts counts;
  counts.pieces = 7500;
  scene.status.ports = {{"mocap", counts}, {"kinect", counts}};
  CHECK(lab_table(scene.lab, scene.status).size() == 5);
  scene.status.ports[0].second.dropped = 1234;
  const auto lines = lab_table(scene.lab, scene.status);
  REQUIRE(lines.size() == 6);
  CHECK(lines[2].text == "mocap              1,234 dropped by the kernel");
  CHECK(lines[2].bad);
  CHECK(!lines[1].bad);
}

TEST_CASE("a sender that another has replaced is not missing, and soon not shown") {
  Scene scene;
  StreamStatus again = scene.status.streams[1];  // the silent Kinect
  again.sender = "192.168.7.5:51300";
  again.heard = scene.status.now;
  scene.status.streams.push_back(again);
  const auto lines = lab_table(scene.lab, scene.status);
  REQUIRE(lines.size() == 6);
  CHECK(!lines[2].bad);
  CHECK(!lines[3].bad);
  scene.status.now += 25s;
  scene.status.streams.back().heard = scene.status.now;
  CHECK(lab_table(scene.lab, scene.status).size() == 5);
}

TEST_CASE("of connections made anew from one port the newest says whether the device is silent") {
  Scene scene;
  StreamStatus again = scene.status.streams[1];  // the Kinect, silent for ten seconds
  again.heard = scene.status.now;
  scene.status.streams.push_back(again);
  const auto newest = newest_of_each(scene.status.streams);
  REQUIRE(newest.size() == 3);
  CHECK(newest[1].stream == "kinect");
  CHECK(newest[1].heard == scene.status.now);
}

TEST_CASE("what is not required is missing without red") {
  Scene scene;
  for (DeviceOptions& device : scene.lab.devices) device.required = false;
  for (const TableLine& line : lab_table(scene.lab, scene.status)) CHECK(!line.bad);
  CHECK(missing(scene.lab, scene.status).empty());
}

TEST_CASE("missing are required devices that are silent or were never heard, and nodes by place") {
  Scene scene;
  CHECK(missing(scene.lab, scene.status) == std::vector<std::string>{"kinect", "imu wrist"});
  scene.status.streams.clear();
  CHECK(missing(scene.lab, scene.status) ==
        std::vector<std::string>{"mocap", "kinect", "imu wrist", "imu waist"});
}

TEST_CASE("a stream's JSON has its counts and its node's clock") {
  const Scene scene;
  const auto json = nlohmann::json::parse(json_of(scene.status.streams[2], scene.status));
  CHECK(json["stream"] == "imu");
  CHECK(json["node"] == "7");
  CHECK(json["place"] == "waist");
  CHECK(json["lost"] == 3);
  CHECK(json["battery_v"] == 3.7);
  CHECK(json["silent_s"] == doctest::Approx(0.1));
  CHECK(json["clock"]["certainty"] == "certified");
  CHECK(json["clock"]["drift_ppm"] == doctest::Approx(20.1));
  CHECK(!json["clock"].contains("address"));
  CHECK(!nlohmann::json::parse(json_of(scene.status.streams[0], scene.status)).contains("clock"));
}

TEST_CASE("a port's line tells what was not recorded, and nothing else") {
  CHECK(port_line("mocap", {}).empty());
  PortCounts counts;
  counts.dropped = 1234;
  counts.refused = 3;
  CHECK(port_line("mocap", counts) ==
        "  port of mocap: 1,234 dropped by the kernel, 3 refused, not recorded\n");
}
