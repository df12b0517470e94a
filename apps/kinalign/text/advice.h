// SPDX-License-Identifier: Apache-2.0
// Advice for a port that can't be opened and for a key file that can't be read.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// A port that the program wants to open, and the flags or settings that set it. The advice names
/// these flags, so that the user knows what to change.
struct WantedPort {
  std::uint16_t port = 0;
  std::string port_from;     // the flag or setting of the port: "--port"
  std::string address_from;  // the flag or setting of the address: "--listen"
  bool tcp = false;
};

/// Advice for a port that could not be opened. Empty if no advice is known.
std::vector<std::string> port_advice(const Error& error, const WantedPort& wanted);

/// Advice if the file of --lab-key could not be read. If other users can read the key, there is no
/// advice, because the error itself says what to do.
std::vector<std::string> key_advice(const Error& error);

}  // namespace kinalign
