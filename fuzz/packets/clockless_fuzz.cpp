// SPDX-License-Identifier: Apache-2.0
// The three datagrams of a node without a counter; each input is tried as all three: see
// node_datagrams.h.
#include "fuzz/packets/node_datagrams.h"

#include "kinalign/wire/clockless.h"

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check_datagram<ClocklessRequest>(DatagramType::request, data, size);
  check_datagram<ClocklessAnswer>(DatagramType::answer, data, size);
  check_datagram<ClocklessConfirm>(DatagramType::confirm, data, size);
  return 0;
}
