// SPDX-License-Identifier: Apache-2.0
// The text about the time server itself: lines for people, members of JSON objects for programs.
#pragma once

#include "kinalign/capture/ntp/ntp_responder.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The addresses and ports of the server.
/// With port 0 the system chose the ports, so these are the real ones.
struct ServedPort {
  std::vector<std::string> addresses;  // addresses that it listens on: "0.0.0.0", "::1"
  std::vector<std::string> reachable;  // addresses of this host, for clients
  std::uint16_t port = 123;
  std::optional<std::uint16_t> node_port{};  // for inertial nodes
  bool keyed = false;                        // the nodes have keys
};

/// The first lines: addresses, the quality of the clock, the settings for clients.
std::string start_lines(const ServedPort& served, const NtpServerState& state);
std::string start_json(const ServedPort& served, const NtpServerState& state);

/// "synchronised within 12.3 ms, stratum 9"; no line end.
std::string clock_text(const NtpServerState& state);
std::string clock_json(const NtpServerState& state);

/// "2026-11-22T17:38:23Z"
std::string utc_text(Time t);

/// "2026-11-22T17:38:23Z kinalign time-server: node 7: joined", dated like the lines of chronyd.
std::string live_line(Time now, std::string_view what);

/// "1,234 NTP requests answered, 5 limited". Outcomes that did not occur are left out, but for
/// answered ones.
std::string counts_text(const NtpCounts& counts);
/// `event`: "counts" while the server runs, "stopped" at its end.
std::string counts_json(const NtpCounts& counts, const std::string& event, double elapsed_s);

}  // namespace kinalign
