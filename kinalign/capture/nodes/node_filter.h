// SPDX-License-Identifier: Apache-2.0
// What the kernel itself keeps from the nodes' port, before it takes room in the buffer.
#pragma once

#include "kinalign/capture/net/udp_socket.h"

namespace kinalign {

/// From now on the socket takes only what begins as a node's datagram and has the length that it
/// says. False: the system has no such filters, and nothing is changed.
bool attach_node_filter(const UdpSocket& socket);

}  // namespace kinalign
