// SPDX-License-Identifier: Apache-2.0
// The flags of verbs that can work live, that is, on data while `record` receives it.
#pragma once

#include "apps/cli/verb.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The values of the flags. `send` and `look_ahead` are allowed only together with `live`.
struct LiveWords {
  std::string live;                        // "[HOST:]PORT" of `record --live-port`; empty: not live
  std::string send;                        // "HOST:PORT" to which each frame is sent; empty: none
  std::optional<std::int64_t> look_ahead;  // frames
};

/// The flags --live, --look-ahead and --send.
std::vector<Field> live_flags(LiveWords& o);

/// A numeric address and a port.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};

/// Parses a port from 1 to 65535. Empty for any other text.
std::optional<std::uint16_t> parse_port(std::string_view text);

/// Parses an address such as "7040", "127.0.0.1:7040" or "[::1]:7040". Errors name `flag`.
Result<Endpoint> parse_endpoint(const std::string& text, const std::string& flag);

/// Fails if the flags contradict each other or the input, or if an address can't be parsed. `in`:
/// the input files.
Result<void> check(const LiveWords& o, const std::vector<std::string>& in);

}  // namespace kinalign
