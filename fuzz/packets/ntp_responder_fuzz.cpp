// SPDX-License-Identifier: Apache-2.0
// A stream of datagrams, each from an address and at a time of its own. A datagram that is answered
// was a request of at least 48 bytes, the answer holds its stamp, and no address gets more answers
// than the limit allows.
#include "kinalign/capture/ntp/ntp_responder.h"
#include "kinalign/wire/bytes.h"

#include <algorithm>
#include <cstdlib>
#include <map>

using namespace kinalign;

namespace {

void check(const NtpAsked& asked, std::span<const std::uint8_t> answer) {
  if (asked.bytes.size() < answer.size()) std::abort();
  const bool own_stamp =
      std::equal(answer.begin() + 24, answer.begin() + 32, asked.bytes.begin() + 40);
  const bool server = (answer[0] & 7U) == ntp_mode_server;
  if (!own_stamp || !server || asked.from_port == 0 || !asked.unicast) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  NtpResponder responder(SipHashKey{},
                         {AddressBlock{mapped_ipv4(std::array<std::uint8_t, 4>{10}), 104}});
  std::map<HostAddress, std::int64_t> answered;
  ByteReader reader({data, size});
  HostTime now{std::chrono::hours(1)};
  const HostTime begin = now;
  while (reader.left() > 8) {
    NtpAsked asked;
    const std::array<std::uint8_t, 4> from{reader.take<std::uint8_t>(), 0, 0, 1};
    asked.from = mapped_ipv4(from);
    asked.from_port = reader.take<std::uint16_t>();
    asked.to_port = 123;
    const auto flags = reader.take<std::uint8_t>();
    asked.unicast = (flags & 1U) == 0;
    asked.cut = (flags & 2U) != 0;
    now += std::chrono::milliseconds(reader.take<std::uint8_t>());
    const std::size_t length = std::min<std::size_t>(reader.take<std::uint8_t>(), reader.left());
    asked.bytes = {data + size - reader.left(), length};
    for (std::size_t i = 0; i < length; ++i) reader.take<std::uint8_t>();
    std::array<std::uint8_t, ntp_packet_size> answer{};
    const NtpOutcome outcome = responder.respond(asked, Time{}, now, answer);
    const bool sent = outcome == NtpOutcome::answered || outcome == NtpOutcome::kissed;
    if (sent) check(asked, answer);
    if (outcome != NtpOutcome::answered || from[0] == 10) continue;
    const std::int64_t most = RateLimit::burst + (now - begin) / RateLimit::interval;
    if (++answered[asked.from] > most) std::abort();
  }
  return 0;
}
