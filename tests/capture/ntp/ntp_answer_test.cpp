// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/ntp_answer.h"

#include "tests/ntp_client.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

const Time t2 = utc_time(1'790'000'000'250'000'000);

NtpServerState state() {
  NtpServerState state;
  state.leap = NtpLeap::none;
  state.stratum = 10;
  state.precision = -24;
  state.reference_id = 0x7f7f0100;
  state.root_delay = 500ms;
  state.root_dispersion = 1s;
  state.reference = t2 - 250ms;
  state.read = t2;
  return state;
}

NtpPacket request() {
  NtpPacket request;
  request.leap = NtpLeap::unsynchronised;
  request.version = 3;
  request.mode = ntp_mode_client;
  request.stratum = 3;
  request.poll = 6;
  request.precision = 32;
  request.root_delay = {0x12345678};
  request.originate = {5};
  request.receive = {6};
  request.transmit = {0xdeadbeef01020304};
  return request;
}

}  // namespace

TEST_CASE("an answer byte by byte") {
  const auto bytes = encode(ntp_answer(request(), t2, t2 + 500ms, state()));
  const std::array<std::uint8_t, 48> expected{
      0x1c, 0x0a, 0x06, 0xe8,                          // leap 0, version 3, mode 4; 10; 6; -24
      0x00, 0x00, 0x80, 0x00,                          // root delay 0.5 s
      0x00, 0x01, 0x00, 0x01,                          // 1 s, and 7.5 us for its age, rounded up
      0x7f, 0x7f, 0x01, 0x00,                          // 127.127.1.0
      0xee, 0x5b, 0xba, 0x00, 0x00, 0x00, 0x00, 0x00,  // 3,998,988,800 s since 1900
      0xde, 0xad, 0xbe, 0xef, 0x01, 0x02, 0x03, 0x04,  // the request's transmit stamp, verbatim
      0xee, 0x5b, 0xba, 0x00, 0x40, 0x00, 0x00, 0x00,  //
      0xee, 0x5b, 0xba, 0x00, 0xc0, 0x00, 0x00, 0x00};
  CHECK(bytes == expected);
}

TEST_CASE("the answer repeats only version, poll and transmit stamp of the request") {
  NtpPacket bare;
  bare.version = 3;
  bare.mode = ntp_mode_client;
  bare.poll = 6;
  bare.transmit = request().transmit;
  CHECK(ntp_answer(bare, t2, t2, state()) == ntp_answer(request(), t2, t2, state()));
}

TEST_CASE("root dispersion grows by 15 ppm from when it was read, and never shrinks") {
  const auto dispersion = [](Duration age) {
    return ntp_answer(request(), t2, t2 + age, state()).root_dispersion.bits;
  };
  CHECK(dispersion(0s) == 0x10000);
  CHECK(dispersion(-10s) == 0x10000);  // the clock was stepped back
  CHECK(dispersion(1000s) == doctest::Approx(0x10000 * 1.015).epsilon(1e-4));
}

TEST_CASE("fault 20 host_backwards: an answer never leaves before its request came") {
  CHECK(transmit_stamp(t2, t2 + 10us) == t2 + 10us);
  CHECK(transmit_stamp(t2, t2) == t2);
  CHECK(transmit_stamp(t2, t2 - 1ms) == t2);
}

TEST_CASE(
    "fault 17 host_step: where the clock was stepped between the stamps nothing is answered") {
  for (const Duration step : std::initializer_list<Duration>{1h, -1h, 1001ms, -1001ms}) {
    CHECK(transmit_stamp(t2, t2 + step) == std::nullopt);
  }
  CHECK(transmit_stamp(t2, t2 + 1s) == t2 + 1s);
}

TEST_CASE(
    "fault 27 kod: the kiss RATE answers the request with true stamps and asks for 2 s at least") {
  const NtpPacket kiss = ntp_kiss_rate(request(), t2, t2 + 1us, state());
  const NtpPacket read = ntp_answer_in(encode(kiss), request().transmit).value();
  CHECK(read.stratum == 0);
  CHECK(read.reference_id == ntp_code("RATE"));
  CHECK(read.receive == ntp_from_time(t2));
  CHECK(read.transmit == ntp_from_time(t2 + 1us));
  CHECK(read.poll == 6);
  NtpPacket eager = request();
  eager.poll = -3;
  CHECK(ntp_kiss_rate(eager, t2, t2, state()).poll == 1);
}

TEST_CASE(
    "fault 21 era_2036: an answer that spans the wrap has stamps on both sides and none of 0") {
  const Time wrap = utc_time(2'085'978'496'000'000'000);
  NtpServerState now = state();
  now.reference = now.read = wrap - 1s;
  const NtpPacket before = ntp_answer(request(), wrap - 1ms, wrap, now);
  CHECK((before.receive.bits >> 32) == 0xffffffff);
  CHECK(before.transmit.bits == 1);
  CHECK(ntp_difference(before.receive, before.transmit) == 1ms);
  CHECK(time_from_ntp(before.reference, wrap) == wrap - 1s);
}
