// SPDX-License-Identifier: Apache-2.0
// The causes for which a frame is refused, one by one; node_frame_laws_test.cpp has the rules for
// any frame.
#include "kinalign/wire/node_frame.h"

#include "tests/wire/node_cases.h"

#include "kinalign/wire/bytes.h"
#include "kinalign/wire/crc32.h"
#include "kinalign/wire/node_layout.h"

#include <doctest/doctest.h>

#include <cstring>
#include <functional>
#include <limits>

using namespace kinalign;

namespace {

NodeSample sample_of_both() {
  NodeSample sample;
  sample.has_acceleration = sample.has_angular_velocity = true;
  return sample;
}

NodeFrame frame_of(std::size_t samples, const NodeSample& sample = sample_of_both()) {
  NodeFrame frame;
  frame.origin = {7, 0x5eedf00d, 1000};
  frame.sample_count = samples;
  for (std::size_t i = 0; i < samples; ++i) frame.samples[i] = sample;
  return frame;
}

/// A frame whose bytes were changed before it was sealed.
Bytes altered(const NodeFrame& frame, const MacKey* key,
              const std::function<void(Bytes&)>& change) {
  Bytes bytes = encoded(frame, key);
  change(bytes);
  REQUIRE(!seal(bytes, key).empty());
  return bytes;
}

std::string fate_of_byte(std::size_t at, std::uint8_t value) {
  const auto change = [=](Bytes& bytes) { bytes[at] = value; };
  return fate<NodeFrame>(altered(frame_of(1), &counted_key, change), &counted_key);
}

}  // namespace

TEST_CASE("frames have the sizes stated on the page") {
  CHECK(encoded(frame_of(0), nullptr).size() == 52);
  CHECK(encoded(frame_of(0), &counted_key).size() == 60);
  CHECK(encoded(frame_of(1), nullptr).size() == 81);
  CHECK(encoded(frame_of(1), &counted_key).size() == 89);
  CHECK(encoded(frame_of(10), nullptr).size() == 342);
  CHECK(encoded(frame_of(10), &counted_key).size() == 350);
  NodeSample whole = sample_of_both();
  whole.has_orientation = true;
  CHECK(encoded(frame_of(30, whole), nullptr).size() == 1402);
  CHECK(encoded(frame_of(30, whole), &counted_key).size() == 1410);
  CHECK(max_node_datagram <= 1452);  // Ethernet's 1500 minus the heads of IPv6 and UDP
}

TEST_CASE("a frame of more samples than fit is not written") {
  NodeFrame frame = frame_of(30);
  frame.sample_count = 31;
  CHECK(encoded(frame, nullptr).empty());
}

TEST_CASE("each damaged or foreign part of a frame has its own cause") {
  CHECK(fate_of_byte(0, 'k') == "bad_magic");
  CHECK(fate_of_byte(4, 0) == "unknown_version");
  CHECK(fate_of_byte(5, 0) == "wrong_type");
  CHECK(fate_of_byte(5, 2) == "wrong_type");  // a reply
  CHECK(fate_of_byte(5, 6) == "wrong_type");
  CHECK(fate_of_byte(7, 88) == "wrong_length");
  CHECK(fate_of_byte(20, 1 + 8) == "stray_bits");  // flags
  CHECK(fate_of_byte(23, 1) == "stray_bits");      // a battery without its flag
  CHECK(fate_of_byte(47, 1) == "stray_bits");      // an echo without its flag
  CHECK(fate_of_byte(52, 1 + 2 + 16) == "stray_bits");
  CHECK(fate_of_byte(52, 2 + 8) == "stray_bits");  // gravity flag without an acceleration
  CHECK(fate_of_byte(21, 31) == "too_many_samples");
  CHECK(fate_of_byte(21, 0) == "wrong_fields");
  CHECK(fate_of_byte(21, 2) == "wrong_fields");
  CHECK(fate_of_byte(52, 1) == "wrong_fields");
  CHECK(fate_of_byte(0, 'K') == "none");
  Bytes damaged = encoded(frame_of(1), &counted_key);
  damaged[30] ^= 1;
  CHECK(fate<NodeFrame>(damaged, &counted_key) == "bad_crc");
}

TEST_CASE("a newer version is refused by its number, whatever stands behind it") {
  Bytes bytes = encoded(frame_of(1), nullptr);
  bytes[4] = 2;
  Envelope envelope;
  CHECK(open_envelope(bytes, envelope) == NodeRefusal::unknown_version);
  CHECK(envelope.version == 2);
  CHECK(envelope.datagram.empty());
}

TEST_CASE("the node of an undamaged frame is known before its key") {
  Envelope envelope;
  const Bytes bytes = encoded(frame_of(1), &counted_key);
  REQUIRE(open_envelope(bytes, envelope) == NodeRefusal::none);
  CHECK(envelope.type == DatagramType::frame);
  CHECK(envelope.origin == DatagramOrigin{7, 0x5eedf00d, 1000});
  CHECK(envelope.has_mac);
}

TEST_CASE("each of the MAC's bytes counts") {
  for (std::size_t i = 0; i < node_mac_size; ++i) {
    CAPTURE(i);
    Bytes bytes = encoded(frame_of(1), &counted_key);
    const std::span whole(bytes);
    const auto covered =
        whole.first(whole.size() - node_crc_size);  // refused by the CRC, which is last
    covered[covered.size() - node_mac_size + i] ^= 1;
    ByteWriter(whole.last(node_crc_size)).put(crc32(covered));
    CHECK(fate<NodeFrame>(bytes, &counted_key) == "wrong_mac");
  }
}

TEST_CASE("fields are not looked at before the MAC is right") {
  const auto change = [](Bytes& bytes) { bytes[21] = 255; };
  const MacKey other{};
  CHECK(fate<NodeFrame>(altered(frame_of(1), &other, change), &counted_key) == "wrong_mac");
}

TEST_CASE("a frame refused for its second sample leaves nothing") {
  NodeFrame arrived = frame_of(3);
  const auto change = [](Bytes& bytes) { bytes[52 + 29] = 255; };  // the flags of the second sample
  CHECK(received(altered(frame_of(2), nullptr, change), nullptr, arrived) ==
        NodeRefusal::reserved_bits);
  CHECK(arrived == NodeFrame{});
}

TEST_CASE("a frame with room for a MAC but none in it is none with a MAC") {
  Bytes bytes(30);  // a flag for a MAC, and two bytes between head and CRC
  const Bytes whole = encoded(frame_of(0), &counted_key);
  std::memcpy(bytes.data(), whole.data(), 24);
  bytes[7] = 30;
  REQUIRE(!seal(bytes, nullptr).empty());
  CHECK(fate<NodeFrame>(bytes, &counted_key) == "wrong_fields");
}

TEST_CASE("numbers are not judged: they come through bit for bit and are marked") {
  NodeSample sample = sample_of_both();
  CHECK(!faults(sample).not_finite);
  CHECK(!faults(sample).zero_orientation);
  sample.acceleration[1] = std::numeric_limits<float>::signaling_NaN();
  sample.angular_velocity[2] = -std::numeric_limits<float>::infinity();
  sample.has_orientation = true;
  const Bytes bytes = encoded(frame_of(1, sample), nullptr);
  NodeFrame arrived;
  REQUIRE(received(bytes, nullptr, arrived) == NodeRefusal::none);
  CHECK(encoded(arrived, nullptr) == bytes);
  CHECK(faults(arrived.samples[0]).not_finite);
  CHECK(faults(arrived.samples[0]).zero_orientation);
  arrived.samples[0].has_acceleration = arrived.samples[0].has_angular_velocity = false;
  CHECK(!faults(arrived.samples[0]).not_finite);  // only values that are present are checked
  arrived.samples[0].orientation = {0, 0, 1e-30F, 0};
  CHECK(!faults(arrived.samples[0]).zero_orientation);
}
