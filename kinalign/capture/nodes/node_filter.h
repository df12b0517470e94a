// SPDX-License-Identifier: Apache-2.0
// A kernel filter for the nodes' port. It drops foreign datagrams before they use buffer space.
#pragma once

#include "kinalign/capture/net/udp_socket.h"

namespace kinalign {

/// Makes the socket accept only datagrams that begin as a node's datagram and whose length field is
/// right. Returns false if the system has no such filters; nothing is changed then.
bool attach_node_filter(const UdpSocket& socket);

}  // namespace kinalign
