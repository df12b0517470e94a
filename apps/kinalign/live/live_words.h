// SPDX-License-Identifier: Apache-2.0
// The flags of verbs that work live with the data that record receives.
#pragma once

#include "apps/cli/verb.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The values of the flags. The other two flags are legal only with `live`.
struct LiveWords {
  std::string live;                        // "[HOST:]PORT" of record --live-port; empty: not live
  std::string send;                        // "HOST:PORT" for a datagram of each frame; empty: none
  std::optional<std::int64_t> look_ahead;  // frames
};

/// The flags live, look_ahead and send.
std::vector<Field> live_flags(LiveWords& o);

/// A numeric address and a port.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};

/// A port from 1 to 65535; absent for any other text.
std::optional<std::uint16_t> parse_port(std::string_view text);

/// Accepts "7040", "127.0.0.1:7040", "[::1]:7040". `flag`: named in errors.
Result<Endpoint> parse_endpoint(const std::string& text, const std::string& flag);

/// Fails if flags contradict each other or the input, or if an endpoint can't be read. `in`: the
/// input files.
Result<void> check(const LiveWords& o, const std::vector<std::string>& in);

}  // namespace kinalign
