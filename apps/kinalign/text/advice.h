// SPDX-License-Identifier: Apache-2.0
// Advice for a port that can't be opened and for a key that can't be read.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// A port that the program wants to open, and the flags or settings that name it.
/// The flag names stand in the advice, since the user must know what to change.
struct WantedPort {
  std::uint16_t port = 0;
  std::string port_from;     // the flag or setting: "--port"
  std::string address_from;  // the flag or setting: "--listen"
  bool tcp = false;
};

/// Advice on the error of opening the port. Empty if no advice is known.
std::vector<std::string> port_advice(const Error& error, const WantedPort& wanted);

/// Advice if --lab-key could not be read.
/// A key that other users can read gets no advice here: the error itself says what to do.
std::vector<std::string> key_advice(const Error& error);

}  // namespace kinalign
