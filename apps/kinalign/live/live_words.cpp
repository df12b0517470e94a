// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_words.h"

#include "kinalign/core/numbers.h"

namespace kinalign {

namespace {

constexpr const char* own_machine = "127.0.0.1";

/// The host without the brackets of an IPv6 address: "[::1]" gives "::1".
std::string without_brackets(const std::string& host) {
  const bool has = host.size() > 2 && host.front() == '[' && host.back() == ']';
  return has ? host.substr(1, host.size() - 2) : host;
}

}  // namespace

std::optional<std::uint16_t> parse_port(std::string_view text) {
  std::uint16_t port = 0;
  // Port 0 is no destination, since it means "any port" to the system.
  return parse_integer(text, port) && port != 0 ? std::optional(port) : std::nullopt;
}

std::vector<Field> live_flags(LiveWords& o) {
  return {text_flag("live", "instead of IN: live data from a kinalign record with this --live-port",
                    &o.live, "[HOST:]PORT"),
          {"look_ahead",
           "with --live: later frames that an answer waits for; a larger number gives a more "
           "accurate but later answer",
           &o.look_ahead,
           0.0,
           1000.0,
           {},
           "FRAMES"},
          text_flag("send",
                    "with --live: also send each frame to this address as a UDP datagram of JSON",
                    &o.send, "HOST:PORT")};
}

Result<Endpoint> parse_endpoint(const std::string& text, const std::string& flag) {
  // The last colon separates the port, because an IPv6 address itself contains colons.
  const std::size_t colon = text.rfind(':');
  Endpoint out{own_machine, 0};
  if (colon != std::string::npos) out.host = without_brackets(text.substr(0, colon));
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  out.port = parse_port(port).value_or(0);
  if (!out.host.empty() && out.port != 0) return out;
  return Failure(
      Error{flag, 0, "a port from 1 to 65535, such as 7040 or 127.0.0.1:7040", shown(text)});
}

Result<void> check(const LiveWords& o, const std::vector<std::string>& in) {
  if (o.live.empty()) {
    if (o.look_ahead) return Failure(Error{"--look-ahead", 0, "--live as well", "no --live"});
    if (!o.send.empty()) return Failure(Error{"--send", 0, "--live as well", "no --live"});
    if (in.empty()) return Failure(Error{"IN", 0, "a file, or --live PORT", "neither"});
    return {};
  }
  if (!in.empty()) return Failure(Error{"--live", 0, "no file as well", shown(in.front())});
  KA_TRY(parse_endpoint(o.live, "--live"));
  if (!o.send.empty()) KA_TRY(parse_endpoint(o.send, "--send"));
  return {};
}

}  // namespace kinalign
