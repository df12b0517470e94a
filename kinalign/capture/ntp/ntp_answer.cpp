// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/ntp_answer.h"

#include <algorithm>

namespace kinalign {

// After a small backward step of the clock, `now` may be earlier than `received`. The answer must
// not state that it was sent before the request arrived.
std::optional<Time> transmit_stamp(Time received, Time now) {
  constexpr Duration most = std::chrono::seconds(1);
  if (now > received + most || now < received - most) return std::nullopt;
  return std::max(received, now);
}

NtpPacket ntp_answer(const NtpPacket& request, Time received, Time transmit,
                     const NtpServerState& state) {
  constexpr std::int64_t seldom = 66'667;  // 1 / 15 ppm
  // The clock's error grows while no program corrects it.
  const Duration age = std::max(transmit - state.read, Duration{0});
  NtpPacket answer;
  answer.leap = state.leap;
  answer.version = request.version;
  answer.mode = ntp_mode_server;
  answer.stratum = state.stratum;
  answer.poll = request.poll;
  answer.precision = state.precision;
  answer.root_delay = ntp_short_from(state.root_delay);
  answer.root_dispersion = ntp_short_from(state.root_dispersion + age / seldom);
  answer.reference_id = state.reference_id;
  answer.reference = ntp_from_time(state.reference);
  answer.originate = request.transmit;
  answer.receive = ntp_from_time(received);
  answer.transmit = ntp_from_time(transmit);
  return answer;
}

NtpPacket ntp_kiss_rate(const NtpPacket& request, Time received, Time transmit,
                        const NtpServerState& state) {
  // log2 of seconds: 2 s, the interval that the rate limit allows (rate_limit.h)
  constexpr std::int8_t least_poll = 1;
  NtpPacket kiss = ntp_answer(request, received, transmit, state);
  // A kiss has stratum 0, and its code is in the field reference_id.
  kiss.leap = NtpLeap::unsynchronised;
  kiss.stratum = 0;
  kiss.reference_id = ntp_code("RATE");
  kiss.poll = std::max(request.poll, least_poll);
  return kiss;
}

}  // namespace kinalign
