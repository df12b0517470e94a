// SPDX-License-Identifier: Apache-2.0
// Datagrams of nodes for tests: random ones of any kind, and a receiver's verdict on them.
#pragma once

#include "kinalign/wire/clockless.h"
#include "kinalign/wire/node_frame.h"
#include "kinalign/wire/node_reply.h"

#include <random>
#include <string>
#include <vector>

namespace kinalign {

using Bytes = std::vector<std::uint8_t>;

inline const MacKey counted_key{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// The bytes of the datagram; empty if it was refused.
template <class Datagram>
Bytes encoded(const Datagram& datagram, const MacKey* key) {
  Bytes out(max_node_datagram);
  out.resize(encode(datagram, key, out).size());
  return out;
}

template <class Datagram>
NodeRefusal received(const Bytes& bytes, const MacKey* key, Datagram& datagram) {
  Envelope envelope;
  const NodeRefusal refusal = open_envelope(bytes, envelope);
  return refusal == NodeRefusal::none ? decode(envelope, key, datagram) : refusal;
}

/// "none", or the reason of the refusal.
template <class Datagram>
std::string fate(const Bytes& bytes, const MacKey* key) {
  Datagram datagram;
  return refusal_name(received(bytes, key, datagram));
}

template <class T>
T any(std::mt19937_64& random) {
  return static_cast<T>(random());
}

inline DatagramOrigin any_origin(std::mt19937_64& random) {
  return {any<std::uint32_t>(random), any<std::uint32_t>(random), any<std::uint32_t>(random)};
}

template <std::size_t n>
std::array<float, n> any_vector(std::mt19937_64& random) {
  std::array<float, n> vector{};
  for (float& x : vector) x = std::uniform_real_distribution<float>(-100, 100)(random);
  return vector;
}

inline NodeSample any_sample(std::mt19937_64& random) {
  NodeSample sample;
  sample.age_us = any<std::uint32_t>(random);
  sample.has_acceleration = random() % 2 != 0;
  sample.has_angular_velocity = random() % 2 != 0;
  sample.has_orientation = random() % 2 != 0;
  sample.gravity_included = sample.has_acceleration && random() % 2 != 0;
  if (sample.has_acceleration) sample.acceleration = any_vector<3>(random);
  if (sample.has_angular_velocity) sample.angular_velocity = any_vector<3>(random);
  if (sample.has_orientation) sample.orientation = any_vector<4>(random);
  return sample;
}

inline NodeFrame any_frame(std::mt19937_64& random) {
  NodeFrame frame;
  frame.origin = any_origin(random);
  frame.n_tx_us = random();
  frame.has_battery = random() % 2 != 0;
  if (frame.has_battery) frame.battery_mv = any<std::uint16_t>(random);
  frame.has_echo = random() % 2 != 0;
  if (frame.has_echo) {
    frame.echo = {any<std::uint32_t>(random), any<std::uint32_t>(random), random()};
  }
  frame.sample_count = random() % (max_node_samples + 1);
  for (std::size_t i = 0; i < frame.sample_count; ++i) frame.samples[i] = any_sample(random);
  return frame;
}

inline NodeReply any_reply(std::mt19937_64& random) {
  return {any_origin(random), random() % 2 != 0, any<std::uint32_t>(random),
          any<std::uint32_t>(random), random()};
}

inline ClocklessRequest any_request(std::mt19937_64& random) {
  ClocklessRequest request;
  request.origin = any_origin(random);
  request.has_battery = random() % 2 != 0;
  if (request.has_battery) request.battery_mv = any<std::uint16_t>(random);
  request.has_sample = random() % 2 != 0;
  if (request.has_sample) request.sample = any_sample(random);
  return request;
}

inline ClocklessTimes any_times(std::mt19937_64& random) {
  return {any<std::uint32_t>(random), random(), random()};
}

}  // namespace kinalign
