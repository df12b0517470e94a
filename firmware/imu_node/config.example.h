// SPDX-License-Identifier: Apache-2.0
// Copy to config.h, which git ignores: it holds a password and a key.
#pragma once

#include "kinalign/wire/node_datagram.h"

namespace kinalign::config {

inline constexpr char wifi_name[] = "lab";
inline constexpr char wifi_password[] = "";       // empty: an open network
inline constexpr char server[] = "192.168.1.10";  // of the host, in digits; IPv6 too
inline constexpr char server_port[] = "5005";

inline constexpr std::uint32_t node_id = 1;  // another one for each node
inline constexpr bool has_key = false;
inline constexpr MacKey key{};  // this node's own 16 bytes, as the host's key file has them

inline constexpr std::uint32_t sample_rate_hz = 100;  // up to 200
inline constexpr std::uint32_t frame_rate_hz = 15;    // 15 to 30

}  // namespace kinalign::config
