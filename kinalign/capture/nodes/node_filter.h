// SPDX-License-Identifier: Apache-2.0
// A kernel filter for the nodes' port. It drops datagrams of other protocols before they use buffer
// space.
#pragma once

#include "kinalign/capture/net/udp_socket.h"

namespace kinalign {

/// Makes the socket accept only datagrams that begin with a node's magic number and whose length
/// field is right. If the system has no such filters, nothing changes and the result is false.
bool attach_node_filter(const UdpSocket& socket);

}  // namespace kinalign
