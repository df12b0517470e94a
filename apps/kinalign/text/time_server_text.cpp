// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/time_server_text.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/text/summary.h"

#include "kinalign/capture/net/udp_socket.h"
#include "kinalign/capture/ntp/clock_state.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <ctime>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// The names of NTP's leap indicator, in the order of its values 0 to 3 (RFC 5905).
constexpr std::array<std::string_view, 4> leap_names{"none", "insert", "delete", "unsynchronised"};

std::string_view name_of(NtpLeap leap) { return leap_names[static_cast<std::size_t>(leap)]; }

/// The id of the server's time source. It is written like an IPv4 address, as NTP programs do.
std::string reference_text(std::uint32_t id) {
  return fmt::format("{}.{}.{}.{}", id >> 24, id >> 16 & 0xff, id >> 8 & 0xff, id & 0xff);
}

/// Adds the state of the server's clock to a JSON event.
std::string with_state(Json event, const NtpServerState& state) {
  event.update(Json{{"leap", name_of(state.leap)},
                    {"stratum", state.stratum},
                    {"reference_id", reference_text(state.reference_id)},
                    // Delays are in milliseconds. The precision is the exponent of a power of two,
                    // in seconds.
                    {"root_delay_ms", 1e3 * seconds(state.root_delay)},
                    {"root_dispersion_ms", 1e3 * seconds(state.root_dispersion)},
                    {"precision_log2_s", state.precision}});
  return json_text(event);
}

/// Lines that a user copies into the settings of a client. If no address of this host is known, the
/// word ADDRESS stands for it.
std::string client_lines(const ServedPort& served) {
  const std::string host = served.reachable.empty() ? "ADDRESS" : served.reachable.front();
  // Most small NTP clients can't use a port other than 123.
  if (served.port != 123) {
    return fmt::format(
        "  clients  chrony: server {} port {} iburst\n"
        "           most other clients, such as ESP32 and ntpdate, can use port 123 only\n",
        host, served.port);
  }
  return fmt::format(
      "  clients  chrony: server {} iburst\n"
      "           ESP32: esp_sntp_setservername(0, \"{}\")\n",
      host, host);
}

std::string node_lines(const ServedPort& served) {
  if (!served.node_port) return "";
  return fmt::format("  nodes    port {}, {}\n", *served.node_port,
                     served.keyed ? "with keys" : "without keys: any sender can imitate a node");
}

}  // namespace

std::string clock_text(const NtpServerState& state) {
  // An unsynchronised clock is checked first, because all other members of its state mean nothing.
  if (state.leap == NtpLeap::unsynchronised) {
    return "not synchronised and no reference: clients will not follow it";
  }
  const std::string leap =
      state.leap == NtpLeap::none ? "" : ", a leap second at the end of the day (UTC)";
  // With --local-stratum this machine's own clock is the reference of the lab.
  if (state.reference_id == local_reference_id) {
    return fmt::format("not synchronised: this machine is the reference, stratum {}{}",
                       state.stratum, leap);
  }
  // RFC 5905 calls this sum the "root distance".
  const Duration most = state.root_dispersion + state.root_delay / 2;
  const double ms = 1e3 * seconds(most);
  // Errors below 0.1 ms are shown in microseconds.
  const std::string within =
      ms < 0.1 ? fmt::format("{:.0f} us", 1e3 * ms) : fmt::format("{:.1f} ms", ms);
  return fmt::format("synchronised within {}, stratum {}{}", within, state.stratum, leap);
}

std::string start_lines(const ServedPort& served, const NtpServerState& state) {
  std::vector<std::string> at;
  for (const std::string& address : served.addresses) {
    at.push_back(endpoint_text(address, served.port));
  }
  return fmt::format("serving time on {}, UDP\n  clock    {}\n{}{}", fmt::join(at, " and "),
                     clock_text(state), client_lines(served), node_lines(served));
}

/// The event "started" with the addresses, the ports and the state of the clock.
std::string start_json(const ServedPort& served, const NtpServerState& state) {
  Json json{{"event", "started"},
            {"addresses", served.addresses},
            {"port", served.port},
            {"reachable", served.reachable}};
  // Both members exist only if the server also receives nodes.
  if (served.node_port) {
    json["node_port"] = *served.node_port;
    json["node_keys"] = served.keyed;
  }
  return with_state(std::move(json), state);
}

std::string clock_json(const NtpServerState& state) {
  return with_state({{"event", "clock"}}, state);
}

std::string utc_text(Time t) {
  // Fractions of a second are cut off, as in the log of chronyd.
  const auto whole = std::chrono::floor<std::chrono::seconds>(t.time_since_epoch());
  return fmt::format("{:%FT%TZ}", fmt::gmtime(static_cast<std::time_t>(whole.count())));
}

std::string live_line(Time now, std::string_view what) {
  return fmt::format("{} kinalign time-server: {}", utc_text(now), what);
}

std::string counts_text(const NtpCounts& counts) {
  std::string text = counted(counts[NtpOutcome::answered], "NTP request") + " answered";
  // Outcome 0 is "answered". It is printed above, so the loop begins at 1.
  for (std::size_t i = 1; i < ntp_outcomes; ++i) {
    const auto outcome = static_cast<NtpOutcome>(i);
    if (counts[outcome] == 0) continue;
    text += ", " + grouped(counts[outcome]) + " " + spaced(name_of(outcome));
  }
  return text;
}

std::string counts_json(const NtpCounts& counts, const std::string& event, double elapsed_s) {
  Json json{{"event", event},
            // The time is rounded to milliseconds.
            {"elapsed_s", std::round(elapsed_s * 1e3) / 1e3},
            {"received", counts.total()}};
  for (std::size_t i = 0; i < ntp_outcomes; ++i) {
    const auto outcome = static_cast<NtpOutcome>(i);
    json[std::string(name_of(outcome))] = counts[outcome];
  }
  return json_text(json);
}

}  // namespace kinalign
