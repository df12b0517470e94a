// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/xsens/stream.h"

#include "tests/page_bytes.h"
#include "tests/protocols/xsens/xsens_cases.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

constexpr const char* page = "xsens_mvn_stream.md";

Bytes other_type(unsigned type, std::size_t payload) {
  Bytes bytes = bytes_of(xsens_pose(1));
  bytes.resize(24 + payload);
  bytes[4] = static_cast<std::uint8_t>('0' + type / 10);
  bytes[5] = static_cast<std::uint8_t>('0' + type % 10);
  bytes[22] = static_cast<std::uint8_t>(payload >> 8);
  bytes[23] = static_cast<std::uint8_t>(payload);
  return bytes;
}

}  // namespace

TEST_CASE("xsens stream: the page's datagrams are what is read and sent") {
  XsensSample pose = xsens_pose(1);
  std::get<XsensPose>(pose.body).segments[0].position = {0.5F, -0.25F, 0.9375F};
  CHECK(bytes_of_page(page, "pose") == bytes_of(pose));
  CHECK(read_xsens(bytes_of_page(page, "pose")).samples == std::vector{pose});

  XsensSample tracker = xsens_trackers(true);
  auto& trackers = std::get<XsensTrackers>(tracker.body).trackers;
  trackers = {trackers[1]};
  CHECK(bytes_of_page(page, "tracker") == bytes_of(tracker));
  CHECK(read_xsens(bytes_of_page(page, "tracker")).samples == std::vector{tracker});

  const XsensSample code = xsens_time_code();
  CHECK(bytes_of_page(page, "time code") == bytes_of(code, {.long_time_code = true}));
  CHECK(read_xsens(bytes_of_page(page, "time code")).samples == std::vector{code});
}

TEST_CASE("xsens stream: every kind is read as it was sent, old programs' too") {
  for (const auto& sample :
       {xsens_pose(), xsens_trackers(true), xsens_trackers(false), xsens_time_code()}) {
    CHECK(read_xsens(bytes_of(sample)).samples == std::vector{sample});
  }
  for (const auto& sample : {xsens_pose(), xsens_trackers(false), xsens_time_code()}) {
    const auto read = read_xsens(bytes_of(sample, {.payload_size = false}));
    CHECK(read.samples == std::vector{sample});
    CHECK(read.counts.bytes_skipped == 0);
    CHECK(read.findings.empty());
  }
  CHECK(bytes_of(xsens_pose()).size() == 760);  // the size that two other projects found
}

TEST_CASE("xsens stream: where bytes are cut changes nothing") {
  for (const auto seed : fresh_seeds(60)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Bytes bytes;
    for (std::uint32_t k = 0; k < 20; ++k) {
      const std::array samples{xsens_pose(30, k), xsens_trackers(true, k), xsens_time_code(k)};
      const XsensSending how{.items_per_datagram = 1 + random() % 30,
                             .long_time_code = random() % 2 == 0};
      Bytes part = bytes_of(samples[random() % 3], how);
      if (random() % 4 == 0) part = other_type(12, random() % 300);
      if (random() % 3 == 0) part[random() % 24] = static_cast<std::uint8_t>(random());
      if (random() % 5 == 0) part.resize(random() % part.size());
      bytes += part;
      for (auto n = random() % 9; n > 0; --n) bytes.push_back("MXTP02"[random() % 6] & 0xff);
    }
    const auto whole = read_xsens(bytes);
    for (const std::size_t most : {1, 7, 100, 2000}) {
      const auto cut = read_xsens(bytes, most, seed);
      CHECK(cut.samples == whole.samples);
      CHECK(cut.counts == whole.counts);
    }
  }
}

TEST_CASE("xsens stream: the datagrams of a sample are joined in whatever order they come") {
  const XsensSample sample = xsens_pose(30);
  for (const auto seed : fresh_seeds(30)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    auto datagrams = datagrams_of(sample, {.items_per_datagram = 1 + random() % 12});
    std::shuffle(datagrams.begin(), datagrams.end(), random);
    Bytes bytes;
    for (const auto& datagram : datagrams) bytes += datagram;
    CHECK(read_xsens(bytes).samples == std::vector{sample});
  }
}

TEST_CASE("xsens stream: samples whose datagrams are mixed are joined each for itself") {
  const auto a = datagrams_of(xsens_pose(30, 1), {.items_per_datagram = 20});
  const auto b = datagrams_of(xsens_pose(30, 2), {.items_per_datagram = 20});
  XsensSample other = xsens_pose(30, 2);
  other.character = 1;
  const auto c = datagrams_of(other, {.items_per_datagram = 20});
  Bytes bytes;
  for (const auto& part : {a[0], b[0], c[0], b[1], a[1], c[1]}) bytes += part;
  const auto read = read_xsens(bytes);
  CHECK(read.samples == std::vector{xsens_pose(30, 2), xsens_pose(30, 1), other});
  CHECK(read.orders == std::vector{Order::newest, Order::late, Order::newest});
}

TEST_CASE("xsens stream: samples that lack a datagram are dropped, and few are held") {
  Bytes bytes;
  for (std::uint32_t k = 0; k < 10; ++k) {
    bytes += datagrams_of(xsens_pose(30, k), {.items_per_datagram = 20})[k % 2];
  }
  const auto read = read_xsens(bytes);
  CHECK(read.samples.empty());
  CHECK(read.counts[XsensRefusal::incomplete] == 6);
}

TEST_CASE("xsens stream: a doubled datagram of several is dropped, a doubled sample is told") {
  const auto parts = datagrams_of(xsens_pose(30), {.items_per_datagram = 20});
  Bytes bytes;
  for (const auto& part : {parts[0], parts[0], parts[1], parts[1]}) bytes += part;
  auto read = read_xsens(bytes);
  CHECK(read.samples == std::vector{xsens_pose(30)});
  CHECK(read.counts[XsensRefusal::repeated] == 2);
  CHECK(read.findings.at(0).what.found == "repeated (2 times)");
  bytes = parts[0];
  for (const auto& part : {parts[0], parts[1]}) bytes += part;
  read = read_xsens(bytes);
  CHECK(read.findings.at(0).what.found == "repeated (once)");

  bytes = bytes_of(xsens_pose());
  bytes += bytes_of(xsens_pose());
  CHECK(read_xsens(bytes).orders == std::vector{Order::newest, Order::duplicate});
}

TEST_CASE("xsens stream: samples are counted by character and type") {
  Bytes bytes;
  for (std::uint32_t k = 0; k < 10; ++k) {
    if (k != 3 && k != 4) bytes += bytes_of(xsens_pose(23, 0xfffffffc + k));
    bytes += bytes_of(xsens_trackers(true, 0xfffffffc + k));
  }
  const auto read = read_xsens(bytes);
  CHECK(read.channels.at({0, 2}) == SequenceCounts{8, 2, 0, 0, 0, 0});
  CHECK(read.channels.at({0, 23}) == SequenceCounts{10, 0, 0, 0, 0, 0});
}

TEST_CASE("xsens stream: other types are passed over by their size and counted") {
  Bytes bytes = other_type(12, 1000);
  bytes += other_type(1, 28 * 23);
  bytes += other_type(12, 3);
  bytes += bytes_of(xsens_pose());
  const auto read = read_xsens(bytes);
  CHECK(read.samples == std::vector{xsens_pose()});
  CHECK(read.counts.other_types[12] == 2);
  CHECK(read.counts.other_types[1] == 1);
  CHECK(read.counts.bytes_skipped == 0);
  REQUIRE(read.findings.size() == 2);
  CHECK(to_string(read.findings[1].what) ==
        "mvn: expected datagrams of types 02, 23 and 25, found 2 of type 12");
}

TEST_CASE("xsens stream: a wrong size swallows nothing behind it") {
  for (const unsigned size : {1U, 735U, 737U, 1104U, 65535U}) {
    CAPTURE(size);
    Bytes bytes = bytes_of(xsens_pose());
    bytes[22] = static_cast<std::uint8_t>(size >> 8);
    bytes[23] = static_cast<std::uint8_t>(size);
    bytes += bytes_of(xsens_pose(23, 1001));
    const auto read = read_xsens(bytes);
    CHECK(read.samples == std::vector{xsens_pose(23, 1001)});
    CHECK(read.counts[XsensRefusal::wrong_size] + read.counts[XsensRefusal::torn] == 1);
  }
}

TEST_CASE("xsens stream: a lost piece costs its own sample alone") {
  const Bytes one = bytes_of(xsens_pose());
  for (std::size_t lost = 1; lost <= one.size(); ++lost) {
    Bytes bytes(one.begin(), one.end() - static_cast<std::ptrdiff_t>(lost));
    bytes += one;
    bytes += one;
    // The next datagram's header ends the torn datagram if at least six of its bytes lie in the
    // torn one's room.
    CHECK(read_xsens(bytes).samples.size() >= (lost < 6 ? 1U : 2U));
  }
}

TEST_CASE("xsens stream: a time code that is no time is refused") {
  for (const std::string_view text :
       {"24:00:00.000", "12:60:00.000", "12:00:60.000", "12.00.00.000", "1x:00:00.000"}) {
    Bytes bytes = bytes_of(xsens_time_code());
    std::copy(text.begin(), text.end(), bytes.begin() + 24);
    CHECK(read_xsens(bytes).counts[XsensRefusal::wrong_size] == 1);
  }
}

TEST_CASE("xsens stream: a time code of another length than it says is refused") {
  Bytes bytes = bytes_of(xsens_time_code(), {.long_time_code = true});
  bytes[27] = 13;
  CHECK(read_xsens(bytes).counts[XsensRefusal::wrong_size] == 1);
}

TEST_CASE("xsens stream: a sender can't make us hold more than 16 characters of three types") {
  Bytes bytes;
  for (unsigned character = 0; character < 60; ++character) {
    XsensSample sample = xsens_pose();
    sample.character = static_cast<std::uint8_t>(character);
    bytes += bytes_of(sample);
  }
  const auto read = read_xsens(bytes);
  CHECK(read.channels.size() == 48);
  CHECK(read.counts[XsensRefusal::too_many_characters] == 12);
}

TEST_CASE("xsens stream: trackers of two sizes are not joined to one sample") {
  Bytes first = bytes_of(xsens_trackers(true)), last = bytes_of(xsens_trackers(false));
  first[10] = 0;
  last[10] = 0x81;
  first += last;
  const auto read = read_xsens(first);
  CHECK(read.samples.empty());
  CHECK(read.counts[XsensRefusal::wrong_size] == 1);
}

TEST_CASE("xsens stream: more than 256 items are no sample") {
  XsensDecoder decoder;
  std::vector<XsensArrival> arrivals;
  for (unsigned index = 0; index < 20; ++index) {
    Bytes bytes = bytes_of(xsens_pose());
    bytes[10] = static_cast<std::uint8_t>(index);
    decoder.feed(bytes, arrivals);
  }
  CHECK(decoder.counts()[XsensRefusal::too_many_items] == 9);
}
