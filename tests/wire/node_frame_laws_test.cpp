// SPDX-License-Identifier: Apache-2.0
// Rules for any datagram, with a key and without.
#include "tests/seeds.h"
#include "tests/wire/node_cases.h"
#include "tests/witness.h"

#include <doctest/doctest.h>

#include <bit>
#include <sstream>

using namespace kinalign;

namespace {

template <class Datagram>
void check_laws(const Datagram& sent, const MacKey* key) {
  const Bytes bytes = encoded(sent, key);
  Datagram arrived;
  CHECK(received(bytes, key, arrived) == NodeRefusal::none);
  CHECK(arrived == sent);

  Bytes small(bytes.size() - 1);
  CHECK(encode(sent, key, small).empty());

  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    CHECK(fate<Datagram>(cut, key) == (size < 28 ? "too_short" : "wrong_length"));
  }
  Bytes flipped = bytes;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = static_cast<std::uint8_t>(1U << bit % 8);
    flipped[bit / 8] ^= mask;
    Envelope envelope;
    // The error is found without a key.
    CHECK(open_envelope(flipped, envelope) != NodeRefusal::none);
    flipped[bit / 8] ^= mask;
  }
}

template <class Datagram>
void check_keys(const Datagram& sent, std::mt19937_64& random) {
  MacKey key{};
  for (auto& byte : key) byte = any<std::uint8_t>(random);
  check_laws(sent, &key);
  check_laws(sent, nullptr);
  MacKey other = key;
  other[random() % 16] ^= static_cast<std::uint8_t>(1U << random() % 8);
  CHECK(fate<Datagram>(encoded(sent, &key), &other) == "wrong_mac");
  CHECK(fate<Datagram>(encoded(sent, &key), nullptr) == "no_key");
  CHECK(fate<Datagram>(encoded(sent, nullptr), &key) == "no_mac");
}

std::string hex(float value) {
  std::ostringstream out;
  out << std::hex << std::bit_cast<std::uint32_t>(value);
  return out.str();
}

void say(std::ostream& out, const NodeSample& sample) {
  out << "sample " << sample.age_us << ' ' << sample.gravity_included;
  if (sample.has_acceleration) out << " acceleration";
  if (sample.has_acceleration)
    for (const float x : sample.acceleration) out << ' ' << hex(x);
  if (sample.has_angular_velocity) out << " angular_velocity";
  if (sample.has_angular_velocity)
    for (const float x : sample.angular_velocity) out << ' ' << hex(x);
  if (sample.has_orientation) out << " orientation";
  if (sample.has_orientation)
    for (const float x : sample.orientation) out << ' ' << hex(x);
  out << '\n';
}

/// The frame in the same words in which tests/witness/node_frame.py describes its bytes.
std::string said(const NodeFrame& frame) {
  std::ostringstream out;
  out << frame.origin.node_id << ' ' << frame.origin.boot_id << ' ' << frame.origin.sequence << ' '
      << frame.n_tx_us << '\n';
  if (frame.has_battery) out << "battery " << frame.battery_mv << '\n';
  if (frame.has_echo) {
    out << "echo " << frame.echo.reply_sequence << ' ' << frame.echo.nonce << ' '
        << frame.echo.n_rx_us << '\n';
  }
  for (std::size_t i = 0; i < frame.sample_count; ++i) say(out, frame.samples[i]);
  return out.str();
}

}  // namespace

TEST_CASE("a frame comes through as it was sent, or not at all") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    check_keys(any_frame(random), random);
  }
}

TEST_CASE("a reply comes through as it was sent, or not at all") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    check_keys(any_reply(random), random);
  }
}

TEST_CASE("a clockless exchange comes through as it was sent, or not at all") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    check_keys(any_request(random), random);
    check_keys(ClocklessAnswer{any_origin(random), any_times(random)}, random);
    check_keys(ClocklessConfirm{any_origin(random), any_times(random)}, random);
  }
}

TEST_CASE("frames are what Python's struct and zlib read") {
  const FreshFolder folder;
  std::vector<std::string> expected;
  for (const auto seed : fresh_seeds(200)) {
    std::mt19937_64 random(seed);
    const NodeFrame frame = any_frame(random);
    const Bytes bytes = encoded(frame, random() % 2 != 0 ? &counted_key : nullptr);
    folder.write(std::to_string(expected.size()) + ".frame",
                 {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    expected.push_back(said(frame));
  }
  REQUIRE(run_witness("node_frame.py", folder.path()) == 0);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(folder.read(std::to_string(i) + ".txt") == expected[i]);
  }
}
