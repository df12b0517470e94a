// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/kinalign/text/record_text.h"

namespace kinalign {

using namespace std::chrono_literals;

/// A lab one minute after its ports were opened: a mocap that sends, one of two nodes, and a silent
/// Kinect.
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
    mocap.last_arrival = HostTime{159900ms};
    StreamStatus kinect = mocap;
    kinect.stream = "kinect";
    kinect.last_arrival = HostTime{150s};
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

}  // namespace kinalign
