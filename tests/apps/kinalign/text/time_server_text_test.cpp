// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/time_server_text.h"

#include "kinalign/capture/ntp/clock_state.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

NtpServerState local_reference() {
  NtpServerState state;
  state.leap = NtpLeap::none;
  state.stratum = 10;
  state.precision = -25;
  state.reference_id = local_reference_id;
  state.root_dispersion = 1ms;
  return state;
}

}  // namespace

TEST_CASE(
    "the first lines state the addresses, the quality of the clock and the clients' settings") {
  const ServedPort everywhere{{"0.0.0.0", "::"}, {"192.168.7.1", "fd00::2"}, 123};
  CHECK(start_lines(everywhere, local_reference()) ==
        "serving time on 0.0.0.0:123 and [::]:123, UDP\n"
        "  clock    not synchronised: this machine is the reference, stratum 10\n"
        "  clients  chrony: server 192.168.7.1 iburst\n"
        "           ESP32: esp_sntp_setservername(0, \"192.168.7.1\")\n");
  CHECK(start_lines({{"127.0.0.1"}, {}, 12300}, NtpServerState{}) ==
        "serving time on 127.0.0.1:12300, UDP\n"
        "  clock    not synchronised and no reference: clients will not follow it\n"
        "  clients  chrony: server ADDRESS port 12300 iburst\n"
        "           most other clients, such as ESP32 and ntpdate, can use port 123 only\n");
}

TEST_CASE("a synchronised clock is named with its error, a leap second with its day") {
  NtpServerState state = local_reference();
  state.reference_id = 0x7f000001;
  state.stratum = 9;
  state.root_dispersion = 12'340us;
  CHECK(clock_text(state) == "synchronised within 12.3 ms, stratum 9");
  state.root_dispersion = 8us;
  state.root_delay = 5us;
  CHECK(clock_text(state) == "synchronised within 10 us, stratum 9");
  state.leap = NtpLeap::insert;
  CHECK(clock_text(state) ==
        "synchronised within 10 us, stratum 9, a leap second at the end of the day (UTC)");
}

TEST_CASE("a live message has its time of day, in UTC") {
  CHECK(live_line(utc_time(1'795'369'103'900'000'000), "node 7: joined") ==
        "2026-11-22T17:38:23Z kinalign time-server: node 7: joined");
}

TEST_CASE("counts name what there was and leave out the rest; JSON has all of them") {
  NtpCounts counts;
  CHECK(counts_text(counts) == "0 NTP requests answered");
  counts[NtpOutcome::answered] = 1;
  CHECK(counts_text(counts) == "1 NTP request answered");
  counts[NtpOutcome::answered] = 12'345;
  counts[NtpOutcome::wrong_mode] = 7;
  CHECK(counts_text(counts) == "12,345 NTP requests answered, 7 wrong mode");
  const auto json = nlohmann::json::parse(counts_json(counts, "stopped", 1.23456));
  CHECK(json["event"] == "stopped");
  CHECK(json["elapsed_s"] == 1.235);
  CHECK(json["received"] == 12'352);
  CHECK(json["answered"] == 12'345);
  CHECK(json["too_short"] == 0);
  CHECK(json.size() == 3 + ntp_outcomes);
}

TEST_CASE("JSON of the start has place and clock in one object") {
  const auto json = nlohmann::json::parse(start_json({{"::1"}, {"::1"}, 123}, local_reference()));
  CHECK(json["event"] == "started");
  CHECK(json["addresses"] == nlohmann::json{"::1"});
  CHECK(json["port"] == 123);
  CHECK(json["leap"] == "none");
  CHECK(json["stratum"] == 10);
  CHECK(json["reference_id"] == "127.127.1.0");
  CHECK(json["root_dispersion_ms"] == 1.0);
  CHECK(json["precision_log2_s"] == -25);
  CHECK(nlohmann::json::parse(clock_json(NtpServerState{}))["leap"] == "unsynchronised");
}
