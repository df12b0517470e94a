// SPDX-License-Identifier: Apache-2.0
// Texts about the time server itself: lines for people, members of JSON objects for programs.
#pragma once

#include "kinalign/capture/ntp/ntp_responder.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The addresses and ports that the server has opened. If the user gave port 0, these are the ports
/// that the system chose.
struct ServedPort {
  std::vector<std::string> addresses;  // on which it listens: "0.0.0.0", "::1"
  std::vector<std::string> reachable;  // this host's addresses, for clients
  std::uint16_t port = 123;
  std::optional<std::uint16_t> node_port{};  // the port for inertial nodes
  bool keyed = false;                        // true: the nodes have keys
};

/// The first lines that the server prints: addresses, the quality of its clock, settings for
/// clients.
std::string start_lines(const ServedPort& served, const NtpServerState& state);
std::string start_json(const ServedPort& served, const NtpServerState& state);

/// The state of the clock, without a line end: "synchronised within 12.3 ms, stratum 9".
std::string clock_text(const NtpServerState& state);
std::string clock_json(const NtpServerState& state);

/// The date and time in UTC: "2026-11-22T17:38:23Z".
std::string utc_text(Time t);

/// A message with its date, like those of chronyd: "2026-11-22T17:38:23Z kinalign time-server: node
/// 7: joined".
std::string live_line(Time now, std::string_view what);

/// The number of requests by outcome: "1,234 NTP requests answered, 5 limited". The answered ones
/// are always named; other outcomes only if they occurred.
std::string counts_text(const NtpCounts& counts);
/// The counts as a JSON event. `event`: "counts" while the server runs, "stopped" at its end.
std::string counts_json(const NtpCounts& counts, const std::string& event, double elapsed_s);

}  // namespace kinalign
