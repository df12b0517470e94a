// SPDX-License-Identifier: Apache-2.0
// The station of the network in config.h. When to join it again is for LinkPolicy to say.
#pragma once

namespace kinalign {

/// Modem sleep is off from here on: with it a reply waits for the next beacon, 100 ms.
void start_wifi();
/// Whether there is a link with an address.
bool wifi_is_up();
/// Leaves what is left of the link, and asks for it again; returns at once.
void join_wifi();

}  // namespace kinalign
