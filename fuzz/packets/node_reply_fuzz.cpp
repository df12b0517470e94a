// SPDX-License-Identifier: Apache-2.0
// Replies: see node_datagrams.h.
#include "fuzz/packets/node_datagrams.h"

#include "kinalign/wire/node_reply.h"

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check_datagram<NodeReply>(DatagramType::reply, data, size);
  return 0;
}
