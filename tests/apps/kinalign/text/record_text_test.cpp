// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/record_text.h"

#include "apps/kinalign/text/node_names.h"
#include "tests/apps/kinalign/text/lab_scene.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace kinalign;

TEST_CASE("of connections made anew from one port the newest says whether the device is silent") {
  Scene scene;
  StreamStatus again = scene.status.streams[1];  // the Kinect, silent for ten seconds
  again.last_arrival = scene.status.now;
  scene.status.streams.push_back(again);
  const auto newest = newest_of_each(scene.status.streams);
  REQUIRE(newest.size() == 3);
  CHECK(newest[1].stream == "kinect");
  CHECK(newest[1].last_arrival == scene.status.now);
}

TEST_CASE("a line about a device that has sent nothing names its port") {
  Scene scene;
  scene.lab.devices.push_back(*parse_device("suit=noitom:tcp:192.168.7.5:7001"));
  scene.lab.devices.push_back(*parse_device("camera=kinect:tcp-listen:7202"));
  scene.status.ports = {{"suit", {}}, {"camera", {}}};
  scene.status.port_numbers = {
      {"mocap", 7012}, {"kinect", 7201}, {"imu", 5005}, {"suit", 7001}, {"camera", 7202}};
  CHECK(unseen_lines(scene.lab, scene.status) ==
        std::vector<std::string>{"imu wrist: nothing has come to port 5005 yet",
                                 "suit: no connection to 192.168.7.5:7001 yet",
                                 "camera: no device has connected to port 7202 yet"});
  for (auto& [name, counts] : scene.status.ports) counts.links = 1;
  const auto linked = unseen_lines(scene.lab, scene.status);
  CHECK(linked[1] == "suit: nothing has come from 192.168.7.5:7001 yet");
  CHECK(linked[2] == "camera: nothing has come to port 7202 yet");
}

TEST_CASE("missing are required devices that are silent or never sent, and nodes by place") {
  Scene scene;
  CHECK(missing(scene.lab, scene.status) == std::vector<std::string>{"kinect", "imu wrist"});
  scene.status.streams.clear();
  CHECK(missing(scene.lab, scene.status) ==
        std::vector<std::string>{"mocap", "kinect", "imu wrist", "imu waist"});
}

TEST_CASE("a lab's nodes are called by its device's name and their places") {
  Scene scene;
  CHECK(node_names(scene.lab).name(7) == name_of(scene.status.streams[2]));
  CHECK(node_names(scene.lab).name(7) == "imu waist");
  CHECK(node_names(scene.lab).name(8) == "imu 8");
  scene.lab.devices.pop_back();
  CHECK(node_names(scene.lab).name(8) == "node 8");
}

TEST_CASE("a stream's JSON has its counts and its node's clock") {
  const Scene scene;
  const auto json = json_of(scene.status.streams[2], scene.status);
  CHECK(json["stream"] == "imu");
  CHECK(json["node"] == "7");
  CHECK(json["place"] == "waist");
  CHECK(json["lost"] == 3);
  CHECK(json["battery_v"] == 3.7);
  CHECK(json["silent_s"] == doctest::Approx(0.1));
  CHECK(json["clock"]["certainty"] == "certified");
  CHECK(json["clock"]["drift_ppm"] == doctest::Approx(20.1));
  CHECK(!json["clock"].contains("address"));
  CHECK(!json_of(scene.status.streams[0], scene.status).contains("clock"));
}

TEST_CASE("a port's line tells what was not recorded, and nothing else") {
  CHECK(port_line("mocap", {}, 0).empty());
  PortCounts counts;
  counts.dropped = 1234;
  counts.refused = 3;
  CHECK(port_line("mocap", counts, 0) ==
        "  port of mocap: 1,234 dropped by the kernel, 3 refused, not recorded\n");
}

TEST_CASE("the text about datagrams dropped at a nodes' port names them as far as they are known") {
  PortCounts counts;
  counts.sifted = true;
  counts.dropped = 419;
  CHECK(loss_of(counts, 0) == "419 dropped: not frames of nodes");
  CHECK(loss_of(counts, 7) == "419 dropped, at least 412 of them not frames of nodes");
  CHECK(loss_of(counts, 500) == "419 dropped: not frames of nodes, or the buffer was full");
}

TEST_CASE("data at a port of nodes from which no node can be seen is counted in the line") {
  Scene scene;
  scene.status.port_numbers = {{"mocap", 7012}, {"kinect", 7201}, {"imu", 5005}};
  scene.lab.devices.erase(scene.lab.devices.begin(), scene.lab.devices.begin() + 2);
  scene.status.streams.clear();
  PortCounts counts;
  counts.sifted = true;
  scene.status.ports = {{"imu", counts}};
  CHECK(unseen_lines(scene.lab, scene.status)[0] == "imu wrist: nothing has come to port 5005 yet");
  scene.status.ended = true;
  CHECK(unseen_lines(scene.lab, scene.status)[0] == "imu wrist: nothing came");
  scene.status.ports[0].second.dropped = 1181;
  const std::string came =
      "imu wrist: 1,181 datagrams came to port 5005, none of them a frame of nodes";
  CHECK(unseen_lines(scene.lab, scene.status)[0] == came);
  // Frames that were refused, for example because no key was given.
  scene.status.ports[0].second.refused = 4;
  CHECK(unseen_lines(scene.lab, scene.status)[1] ==
        "imu waist: 1,185 datagrams came to port 5005, none of them accepted");
}
