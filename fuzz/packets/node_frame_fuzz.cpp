// SPDX-License-Identifier: Apache-2.0
// Frames: see node_datagrams.h.
#include "fuzz/packets/node_datagrams.h"

#include "kinalign/wire/node_frame.h"

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check_datagram<NodeFrame>(DatagramType::frame, data, size);
  return 0;
}
