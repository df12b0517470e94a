// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/ntp_packet.h"

#include "tests/ntp_client.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <initializer_list>
#include <vector>

using namespace kinalign;

namespace {

constexpr std::int64_t s = 1'000'000'000;
constexpr std::int64_t era_1_s = 2'085'978'496;           // 2036-02-07 06:28:16 UTC
constexpr std::int64_t y2106_s = 4'294'967'296;           // 2106-02-07 06:28:16: 2^32 s since 1970
constexpr std::int64_t y2026 = 1'790'000'000 * s + 1234;  // 2026-09-21

/// A request of chrony 4.3: nothing is set but the first byte, poll, precision and a random
/// transmit stamp.
std::vector<std::uint8_t> chrony_request() {
  std::vector<std::uint8_t> bytes(48);
  bytes[0] = 0x23;
  bytes[2] = 6;
  bytes[3] = 0x20;
  for (std::size_t i = 40; i < 48; ++i) bytes[i] = static_cast<std::uint8_t>(i);
  return bytes;
}

NtpRefusal refusal_of(const std::vector<std::uint8_t>& bytes) {
  NtpPacket packet;
  return decode_request(bytes, packet);
}

/// A request with `more` bytes after it.
std::vector<std::uint8_t> with(std::initializer_list<std::size_t> field_lengths, std::size_t mac,
                               unsigned first = 0x23) {
  auto bytes = chrony_request();
  bytes[0] = static_cast<std::uint8_t>(first);
  for (const std::size_t length : field_lengths) {
    const std::size_t at = bytes.size();
    bytes.resize(at + length);
    bytes[at + 2] = static_cast<std::uint8_t>(length >> 8);
    bytes[at + 3] = static_cast<std::uint8_t>(length);
  }
  bytes.resize(bytes.size() + mac);
  return bytes;
}

}  // namespace

TEST_CASE("a packet's bytes are those of RFC 5905, figure 8") {
  NtpPacket packet;
  packet.leap = NtpLeap::remove;
  packet.version = 4;
  packet.mode = ntp_mode_server;
  packet.stratum = 10;
  packet.poll = 6;
  packet.precision = -20;
  packet.root_delay = {0x00010203};
  packet.root_dispersion = {0x04050607};
  packet.reference_id = 0x7f7f0100;
  packet.reference = {0x1011121314151617};
  packet.originate = {0x2021222324252627};
  packet.receive = {0x3031323334353637};
  packet.transmit = {0x4041424344454647};
  const std::array<std::uint8_t, 48> expected{
      0xa4, 0x0a, 0x06, 0xec, 0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07,
      0x7f, 0x7f, 0x01, 0x00, 0x10, 0x11, 0x12, 0x13, 0x14, 0x15, 0x16, 0x17,
      0x20, 0x21, 0x22, 0x23, 0x24, 0x25, 0x26, 0x27, 0x30, 0x31, 0x32, 0x33,
      0x34, 0x35, 0x36, 0x37, 0x40, 0x41, 0x42, 0x43, 0x44, 0x45, 0x46, 0x47};
  CHECK(encode(packet) == expected);
  CHECK(ntp_header(expected) == packet);
}

TEST_CASE("stamps of known seconds have the bits of RFC 5905, figure 4") {
  CHECK(ntp_from_time(utc_time(0)).bits == 2'208'988'800ULL << 32);               // 1970
  CHECK(ntp_from_time(utc_time(63'072'000 * s)).bits == 2'272'060'800ULL << 32);  // 1972, first UTC
  CHECK(ntp_from_time(utc_time(946'598'400 * s)).bits == 3'155'587'200ULL << 32);  // 1999-12-31
  CHECK(ntp_from_time(utc_time(era_1_s * s - 1)).bits == 0xffff'ffff'ffff'fffcULL);
  CHECK(ntp_from_time(utc_time(era_1_s * s + s)).bits == 1ULL << 32);
  CHECK(ntp_from_time(utc_time(s / 2)).bits == (2'208'988'800ULL << 32 | 0x8000'0000U));
}

TEST_CASE("a stamp is never 0, which would mean unknown") {
  const NtpStamp stamp = ntp_from_time(utc_time(era_1_s * s));
  CHECK(stamp.bits == 1);
  CHECK(time_from_ntp(stamp, utc_time(y2026)) == utc_time(era_1_s * s));
}

TEST_CASE(
    "fault 21 era_2036, y2106: every stamp within 68 years of the pivot comes back to the "
    "nanosecond") {
  constexpr std::int64_t years_68 = (std::int64_t{1} << 31) * s - s;
  const std::vector<std::int64_t> pivots{0, y2026, era_1_s * s, y2106_s * s, -3'000'000'000 * s};
  for (const std::int64_t pivot : pivots) {
    for (const std::int64_t step :
         {-years_68, -s, std::int64_t{-1}, std::int64_t{0}, std::int64_t{1}, s - 1, years_68}) {
      const Time t = utc_time(pivot + step);
      CHECK(time_from_ntp(ntp_from_time(t), utc_time(pivot)) == t);
    }
  }
}

TEST_CASE("law: a stamp and back, and differences, for any times less than 68 years apart") {
  for (const auto seed : fresh_seeds(2000)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<std::int64_t> anywhere(-7'000'000'000 * s, 7'000'000'000 * s);
    std::uniform_int_distribution<std::int64_t> near(-2'147'483'000 * s, 2'147'483'000 * s);
    const Time a = utc_time(anywhere(random));
    const Time b = a + Duration{near(random)};
    CHECK(time_from_ntp(ntp_from_time(b), a) == b);
    // Each stamp is rounded by an eighth of a nanosecond at most, and the difference once more.
    CHECK(std::abs((ntp_difference(ntp_from_time(a), ntp_from_time(b)) - (b - a)).count()) <= 1);
  }
}

TEST_CASE("the first and the last time that Time can hold have a stamp") {
  CHECK(ntp_from_time(utc_time(INT64_MIN)).bits != 0);
  CHECK(ntp_from_time(utc_time(INT64_MAX)).bits != 0);
}

TEST_CASE("fault 21 era_2036: a client's offset stays right across the second") {
  // The client is 0.25 s behind, and each way takes 1 ms. The requests are from 2 s before the wrap
  // to 2 s after it.
  for (const std::int64_t wrap_s : {era_1_s, y2106_s}) {
    for (std::int64_t step = -2 * s; step <= 2 * s; step += s / 8) {
      const Time sent = utc_time(wrap_s * s + step);
      const NtpStamp t1 = ntp_from_time(sent - Duration{s / 4});
      const NtpStamp t2 = ntp_from_time(sent + Duration{1'000'000});
      const NtpStamp t3 = ntp_from_time(sent + Duration{1'500'000});
      const NtpStamp t4 = ntp_from_time(sent + Duration{2'500'000 - s / 4});
      const Duration offset = (ntp_difference(t1, t2) + ntp_difference(t4, t3)) / 2;
      CHECK(std::abs(offset.count() - s / 4) <= 1);
    }
  }
}

TEST_CASE("a short is never less than what it states and within 2^-16 s of it") {
  const auto stated = [](NtpShort value) {
    return Duration{static_cast<std::int64_t>(std::uint64_t{value.bits} * s >> 16)};
  };
  CHECK(ntp_short_from(Duration{0}).bits == 0);
  CHECK(ntp_short_from(Duration{1}).bits == 1);
  CHECK(ntp_short_from(Duration{s}).bits == 0x10000);
  CHECK(ntp_short_from(Duration{-5}).bits == 0);
  CHECK(ntp_short_from(Duration{70'000 * s}).bits == UINT32_MAX);
  CHECK(ntp_short_from(Duration::max()).bits == UINT32_MAX);
  CHECK(stated(NtpShort{0x8000}) == Duration{s / 2});
  for (const std::int64_t ns :
       {std::int64_t{15'258}, std::int64_t{1'000'000}, 16 * s, 65'535 * s}) {
    const Duration back = stated(ntp_short_from(Duration{ns}));
    CHECK(back.count() >= ns - 1);  // the way back is rounded down to a nanosecond
    CHECK(back.count() <= ns + 15'259);
  }
}

TEST_CASE("requests of real clients are taken: their versions, any leap, zeros elsewhere") {
  NtpPacket packet;
  CHECK(decode_request(chrony_request(), packet) == NtpRefusal::none);
  CHECK(packet.transmit.bits == 0x28292a2b2c2d2e2f);
  CHECK(packet.poll == 6);
  CHECK(refusal_of(with({}, 0, 0xe3)) == NtpRefusal::none);  // ntpdate: leap 3
  for (unsigned version = 1; version <= 4; ++version) {
    CHECK(refusal_of(with({}, 0, version << 3 | 3)) == NtpRefusal::none);
  }
}

TEST_CASE("fault 26 wrong_version, wrong_mode, short: each cause has its name") {
  for (std::size_t size = 0; size < 48; ++size) {
    CHECK(refusal_of(std::vector<std::uint8_t>(size, 0x23)) == NtpRefusal::too_short);
  }
  for (const unsigned version : {0U, 5U, 6U, 7U}) {
    CHECK(refusal_of(with({}, 0, version << 3 | 3)) == NtpRefusal::wrong_version);
  }
  for (const unsigned mode : {0U, 1U, 2U, 4U, 5U, 6U, 7U}) {
    CHECK(refusal_of(with({}, 0, 0x20U | mode)) == NtpRefusal::wrong_mode);
  }
}

TEST_CASE("fault 26 long: what follows is a chain of extension fields, a MAC, both, or refused") {
  for (const std::size_t mac : {0U, 4U, 20U, 24U}) {
    CHECK(refusal_of(with({}, mac)) == NtpRefusal::none);
    CHECK(refusal_of(with({28}, mac)) == NtpRefusal::none);
    CHECK(refusal_of(with({16, 28}, mac)) == NtpRefusal::none);
    CHECK(refusal_of(with({1024, 16, 400}, mac)) == NtpRefusal::none);
  }
  for (const std::size_t mac : {1U, 8U, 12U, 16U, 23U, 25U, 27U}) {
    CHECK(refusal_of(with({}, mac)) == NtpRefusal::wrong_trailer);
    CHECK(refusal_of(with({28}, mac)) == NtpRefusal::wrong_trailer);
  }
  CHECK(refusal_of(with({}, 28)) == NtpRefusal::wrong_trailer);  // a field of length 0
  CHECK(refusal_of(with({}, 1452)) == NtpRefusal::wrong_trailer);
  CHECK(refusal_of(with({}, 65'507 - 48)) == NtpRefusal::wrong_trailer);
  CHECK(refusal_of(with({12}, 28)) == NtpRefusal::wrong_trailer);  // shorter than a field
  CHECK(refusal_of(with({30}, 0)) == NtpRefusal::wrong_trailer);   // no multiple of 4
  auto beyond = with({32}, 0);
  beyond[51] = 36;  // states more bytes than there are
  CHECK(refusal_of(beyond) == NtpRefusal::wrong_trailer);
}

TEST_CASE("before version 4 there are no extension fields, and a MAC may have 8 bytes of digest") {
  for (const unsigned first : {0x0bU, 0x13U, 0x1bU}) {
    for (const std::size_t mac : {12U, 20U, 24U}) {
      CHECK(refusal_of(with({}, mac, first)) == NtpRefusal::none);
    }
    CHECK(refusal_of(with({28}, 0, first)) == NtpRefusal::wrong_trailer);
    CHECK(refusal_of(with({}, 4, first)) == NtpRefusal::wrong_trailer);
  }
}
