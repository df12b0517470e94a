// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/node_event_text.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

namespace kinalign {

TEST_CASE("every event has a text and a name, and warnings say that they are") {
  for (std::size_t i = 0; i < node_event_kinds; ++i) {
    NodeEvent event;
    event.kind = static_cast<NodeEvent::Kind>(i);
    event.node_id = 7;
    event.other_id = 6;
    event.version = 2;
    CAPTURE(name_of(event.kind));
    const std::string text = event_text(event);
    CHECK(text.size() > 15);
    CHECK((text.find("warning") != std::string::npos) == is_warning(event.kind));
    const auto json = nlohmann::json::parse(event_json(event));
    CHECK(json["kind"] == name_of(event.kind));
    CHECK(json["warning"] == is_warning(event.kind));
  }
  ClockEvent step;
  step.kind = ClockEvent::Kind::step;
  step.by = -0.02;
  CHECK(event_text(step, 7) == "node 7: warning: its counter stepped by at least 20.000 ms");
  const auto json = nlohmann::json::parse(event_json(step, 0, 7));
  CHECK(json["kind"] == "step");
  CHECK(json["by_ms"] == doctest::Approx(20.0));
  CHECK(!json.contains("curvature_ppm_per_s"));
  ClockEvent relaxed;
  relaxed.kind = ClockEvent::Kind::relaxed;
  relaxed.curvature = 2e-6;
  const auto bends = nlohmann::json::parse(event_json(relaxed, 0, 7));
  CHECK(bends["curvature_ppm_per_s"] == doctest::Approx(2.0));
  CHECK(!bends.contains("by_ms"));
  step.kind = ClockEvent::Kind::slip;
  CHECK(event_text(step, 7) == "node 7: warning: its counter stepped by 20.000 ms");
  step.kind = ClockEvent::Kind::uneasy;
  CHECK(nlohmann::json::parse(event_json(step, 0, 7))["kind"] == "uneasy");
  CHECK(event_text(step, 7).find("intervals stay correct") != std::string::npos);
  for (int kind = 0; kind <= static_cast<int>(ClockEvent::Kind::route); ++kind) {
    step.kind = static_cast<ClockEvent::Kind>(kind);
    CHECK(nlohmann::json::parse(event_json(step, 0, 7))["kind"] != "");
  }
  HostClockEvent slept{HostClockEvent::Kind::suspended, {}, std::chrono::seconds(30)};
  CHECK(event_text(slept) ==
        "warning: this machine slept for 30.0 s; the nodes' clocks are learnt again");
}

TEST_CASE("a node refused for its key is reported with a repair") {
  NodeEvent event;
  event.kind = NodeEvent::Kind::wrong_key;
  event.node_id = 7;
  event.address = {mapped_ipv4(std::array<std::uint8_t, 4>{192, 168, 7, 20}), 4000};
  event.refusal = NodeRefusal::wrong_mac;
  CHECK(event_text(event) ==
        "warning: a sender that calls itself node 7 is refused: it sends frames signed with "
        "another key (from 192.168.7.20:4000); if it is that node, flash the key that kinalign "
        "node-key --lab-key LAB --node 7 prints");
  event.refusal = NodeRefusal::no_mac;
  CHECK(
      event_text(event) ==
      "warning: a sender that calls itself node 7 is refused: it sends frames without a MAC (from "
      "192.168.7.20:4000); if it is that node, flash the key that kinalign node-key --lab-key "
      "LAB --node 7 prints");
  const auto json = nlohmann::json::parse(event_json(event));
  CHECK(json["refusal"] == "no_mac");
  CHECK(json["node_id"] == 7);
  CHECK(json["address"] == "192.168.7.20:4000");
  CHECK_FALSE(json.contains("stream"));
  event.refusal = NodeRefusal::no_key;
  CHECK(event_text(event) ==
        "warning: a sender that calls itself node 7 is refused: it sends frames with a MAC, but "
        "no --lab-key was given (from 192.168.7.20:4000); to accept it, give the lab's key with "
        "--lab-key FILE");
}

TEST_CASE("a node of a lab has the device's name and its place, else its id") {
  const NodeNames names{"imu", {{"7", "wrist"}}};
  NodeEvent event;
  event.node_id = 7;
  event.address = {mapped_ipv4(std::array<std::uint8_t, 4>{192, 168, 7, 20}), 4000};
  CHECK(event_text(event) == "node 7: joined (192.168.7.20:4000)");
  CHECK(event_text(event, names) == "imu wrist: joined (192.168.7.20:4000)");
  event.kind = NodeEvent::Kind::renamed;
  event.other_id = 3;
  CHECK(event_text(event, names) ==
        "imu wrist: seems to be the same device as imu 3 (192.168.7.20:4000)");
  event.kind = NodeEvent::Kind::wrong_key;
  event.refusal = NodeRefusal::wrong_mac;
  CHECK(event_text(event, names) ==
        "warning: a sender that calls itself imu wrist is refused: it sends frames signed with "
        "another key (from 192.168.7.20:4000); if it is that node, flash the key that kinalign "
        "node-key --lab-key LAB --node 7 prints");
  ClockEvent settled;
  settled.kind = ClockEvent::Kind::settled;
  CHECK(event_text(settled, 7, names) == "imu wrist: its counter runs evenly again");
}

}  // namespace kinalign
