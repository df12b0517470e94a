// SPDX-License-Identifier: Apache-2.0
// The flags of verbs that work live from what record receives.
#pragma once

#include "apps/cli/verb.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

struct LiveWords {
  std::string live;  // "[HOST:]PORT" of record --live-port; empty: not live
  std::string send;  // "HOST:PORT" that gets each frame as a datagram; empty: none
  std::optional<std::int64_t> look_ahead;  // frames
};

/// The flags live, look_ahead and send.
std::vector<Field> live_flags(LiveWords& o);

/// An address in numbers, and a port.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};

/// "7040", "127.0.0.1:7040", "[::1]:7040". `flag`: whose it is, for errors.
Result<Endpoint> parse_endpoint(const std::string& text, const std::string& flag);

/// Fails where the flags do not go together with the input, or are none. `in`: the words that are
/// files.
Result<void> check(const LiveWords& o, const std::vector<std::string>& in);

}  // namespace kinalign
