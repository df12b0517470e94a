// SPDX-License-Identifier: Apache-2.0
// Joins the network of config.h as a station. LinkPolicy decides when to join it again.
#pragma once

namespace kinalign {

/// Starts the radio without modem sleep: with it a reply would wait for the next beacon, 100 ms.
void start_wifi();
/// Whether the node has a link and an address.
bool wifi_is_up();
/// Leaves the old link, if there is one, and asks for a new one; returns at once.
void join_wifi();

}  // namespace kinalign
