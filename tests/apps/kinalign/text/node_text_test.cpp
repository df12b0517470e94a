// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/node_text.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

const ClockPair now{.raw = HostTime{std::chrono::hours(1)},
                    .utc = utc_time(1'795'369'168'000'000'000)};  // 2026-11-22T17:39:28Z

NodeStatus some_status() {
  NodeStatus status;
  status.node_id = 7;
  status.boot_id = 5;
  status.address = {mapped_ipv4(std::array<std::uint8_t, 4>{192, 168, 7, 20}), 4000};
  status.accepted = 998;
  status.lost = 2;
  status.rate_hz = 15.02;
  status.battery_mv = 3912;
  status.n = NodeTime{std::chrono::seconds(60)};
  status.drift = 20.1e-6;
  status.drift_deviation = 0.42e-6;
  status.round_trip = std::chrono::microseconds(2004);
  ClockStamp stamp;
  stamp.time = HostTime{std::chrono::seconds(100)};
  stamp.earliest = stamp.time - std::chrono::microseconds(1040);
  stamp.latest = stamp.time + std::chrono::microseconds(1040);
  stamp.certainty = Certainty::certified;
  status.stamp = stamp;
  return status;
}

}  // namespace

TEST_CASE("a node's status is one line, and JSON with times in ns") {
  const NodeStatus status = some_status();
  CHECK(status_text(status, now) ==
        "node 7  15.0/s, 0.2 % lost, ± 1.04 ms, drift +20.1 ± 0.4 ppm, round trip 2.00 ms, 3.91 V");
  const auto json = nlohmann::json::parse(status_json(status));
  CHECK(json["address"] == "192.168.7.20:4000");
  CHECK(json["certainty"] == "certified");
  CHECK(json["time_ns"] == 100'000'000'000);
  CHECK(json["latest_ns"].get<std::int64_t>() - json["earliest_ns"].get<std::int64_t>() ==
        2'080'000);
  CHECK(json["counter_ns"] == 60'000'000'000);
  CHECK(json["drift_ppm"].get<double>() == doctest::Approx(20.1));
  CHECK(json["drift_deviation_ppm"].get<double>() == doctest::Approx(0.42));
  CHECK_FALSE(json.contains("d_ms"));
}

TEST_CASE("a node without a certificate, a counter or samples says so") {
  NodeStatus status = some_status();
  status.stamp->certainty = Certainty::one_sided;
  CHECK(status_text(status, now).find(", not locked: too few exchanges, ") != std::string::npos);
  CHECK(status_text(status, now, "asleep").find(", not locked: asleep, ") != std::string::npos);
  status.stamp->certainty = Certainty::doubtful;
  CHECK(status_text(status, now).find("not locked: its exchanges contradict") != std::string::npos);
  NodeStatus unheard = status;
  unheard.stamp.reset();
  CHECK(status_text(unheard, now).find("not locked: no reply of this server has reached it") !=
        std::string::npos);
  CHECK(nodes_text({some_status(), status}) == "2 nodes, 1 locked");
  NodeStatus bare;
  bare.node_id = 3;
  bare.mean_way = std::chrono::milliseconds(33);
  bare.silent = bare.old_key = true;
  bare.rate_hz = 15.0;
  bare.last_arrival = now.raw - std::chrono::seconds(65);
  CHECK(status_text(bare, now) ==
        "node 3  silent since 2026-11-22T17:38:23Z, no counter: d 33.0 ms, old key");
  CHECK(nodes_text({bare}) == "1 node, 0 locked, 1 silent");
  NodeStatus left = some_status();  // certified at the last frame
  left.silent = true;
  CHECK(nodes_text({some_status(), left}) == "2 nodes, 1 locked, 1 silent");
  CHECK(nodes_text({}).empty());
}

TEST_CASE("what is not known of a node is left out") {
  NodeStatus status = some_status();
  CHECK(nlohmann::json::parse(status_json(status))["rate_hz"] == 15.02);
  CHECK(nlohmann::json::parse(status_json(status))["round_trip_ms"] == doctest::Approx(2.004));
  status.rate_hz.reset();
  for (const auto round_trip : {Duration{0}, Duration{-5000}}) {
    status.round_trip = round_trip;
    CHECK(status_text(status, now) ==
          "node 7  first frame, 0.2 % lost, ± 1.04 ms, drift +20.1 ± 0.4 ppm, 3.91 V");
    const auto json = nlohmann::json::parse(status_json(status));
    CHECK_FALSE(json.contains("rate_hz"));
    CHECK_FALSE(json.contains("round_trip_ms"));
  }
}

TEST_CASE("refused datagrams are printed by cause") {
  NodeCounts counts;
  CHECK(refused_text(counts).empty());
  counts.refusals[NodeRefusal::no_mac] = 1234;
  counts.refusals[NodeRefusal::bad_crc] = 2;
  CHECK(refused_text(counts) == "2 bad crc, 1,234 no mac");
}

TEST_CASE("senders refused for a key are listed by their stated ids") {
  NodeCounts counts;
  RefusedNodes refused;
  CHECK(claims_text(refused, counts).empty());
  counts.refusals[NodeRefusal::wrong_mac] = 6;
  counts.refusals[NodeRefusal::no_mac] = 1200;
  for (const std::uint32_t id : {13U, 11U, 12U, 11U}) refused.take(NodeRefusal::wrong_mac, id, {});
  for (std::uint32_t id = 1; id < 62; ++id) refused.take(NodeRefusal::no_mac, id, {});
  const auto lines = claims_text(refused, counts);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].starts_with("no mac: senders that call themselves node 1, 2, 3, "));
  CHECK(lines[0].ends_with(", 60, 61 (1,200 frames)"));
  CHECK(lines[1] == "wrong mac: senders that call themselves node 11, 12, 13 (6 frames)");
  refused.take(NodeRefusal::wrong_mac, 99, {});  // one more than there is room for
  CHECK(claims_text(refused, counts)[1] ==
        "wrong mac: senders that call themselves node 11, 12, 13 and others (6 frames)");
  CHECK(claims_text(refused, counts, {"imu", {{"12", "wrist"}}})[1] ==
        "wrong mac: senders that call themselves imu 11, wrist, 13 and others (6 frames)");
}

}  // namespace kinalign
