// SPDX-License-Identifier: Apache-2.0
// A packet that is accepted as a request has the size and first byte of one, and its 48 bytes are
// written again unchanged. Any stamp in it survives the way through Time with its own pivot.
#include "tests/ntp_client.h"

#include <algorithm>
#include <cstdlib>

using namespace kinalign;

namespace {

void check_stamp(NtpStamp stamp) {
  if (stamp.bits == 0) return;  // unknown
  const Time time = time_from_ntp(stamp, utc_time(1'790'000'000'000'000'000));
  if (time_from_ntp(ntp_from_time(time), time) != time) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  NtpPacket packet;
  if (decode_request({data, size}, packet) != NtpRefusal::none) return 0;
  const auto written = encode(packet);
  if (size < written.size() || !std::equal(written.begin(), written.end(), data)) std::abort();
  if (packet.mode != ntp_mode_client || packet.version < 1 || packet.version > 4) std::abort();
  for (const NtpStamp stamp : {packet.reference, packet.receive, packet.transmit})
    check_stamp(stamp);
  return 0;
}
