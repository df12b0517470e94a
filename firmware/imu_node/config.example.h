// SPDX-License-Identifier: Apache-2.0
// Copy to config.h, which git ignores: it holds a password and a key.
#pragma once

#include "kinalign/wire/node_datagram.h"

namespace kinalign::config {

inline constexpr char wifi_name[] = "lab";
inline constexpr char wifi_password[] = "";       // empty: an open network
inline constexpr char server[] = "192.168.1.10";  // address of the host in digits, IPv4 or IPv6
inline constexpr char server_port[] = "5005";

inline constexpr std::uint32_t node_id = 1;  // different for each node
inline constexpr bool has_key = false;
inline constexpr MacKey key{};  // this node's own 16 bytes, the same as in the host's key file

inline constexpr std::uint32_t sample_rate_hz = 100;  // up to 200
inline constexpr std::uint32_t frame_rate_hz = 15;    // 15 to 30

}  // namespace kinalign::config
