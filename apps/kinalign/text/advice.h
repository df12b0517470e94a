// SPDX-License-Identifier: Apache-2.0
// Advice where a port can't be opened or a key can't be read.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// A port that is to be served on, and what says so.
struct WantedPort {
  std::uint16_t port = 0;
  std::string port_from;     // "--port"
  std::string address_from;  // "--listen"
  bool tcp = false;
};

/// `error`: of opening it. Empty: nothing is known that would help.
std::vector<std::string> port_advice(const Error& error, const WantedPort& wanted);

/// What to do where --lab-key could not be read.
std::vector<std::string> key_advice(const Error& error);

}  // namespace kinalign
