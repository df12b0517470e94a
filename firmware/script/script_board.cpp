// SPDX-License-Identifier: Apache-2.0
#include "firmware/script/script_board.h"

#include <algorithm>

namespace kinalign {

namespace {

// The counter moves by this in each reading, so that the order of readings shows.
constexpr std::uint64_t reading_takes_us = 7;

template <std::size_t n>
void take_floats(ByteReader& message, std::array<float, n>& values) {
  for (float& value : values) value = message.take_float();
}

}  // namespace

std::uint32_t ScriptBoard::begin_tick(ByteReader& message) {
  now_us_ = message.take<std::uint64_t>();
  const auto due = message.take<std::uint32_t>();
  const auto present = message.take<std::uint8_t>();
  reading_ = {};
  sensor_answers_ = (present & 128) == 0;
  reading_.has_acceleration = (present & 1) != 0;
  reading_.has_angular_velocity = (present & 2) != 0;
  reading_.has_orientation = (present & 4) != 0;
  reading_.gravity_included = (present & 8) != 0;
  take_floats(message, reading_.acceleration);
  take_floats(message, reading_.angular_velocity);
  take_floats(message, reading_.orientation);
  return due;
}

bool ScriptBoard::begin_poll(ByteReader& message) {
  now_us_ = message.take<std::uint64_t>();
  const auto flags = message.take<std::uint8_t>();
  radio_takes_ = (flags & 2) != 0;
  has_battery_ = (flags & 4) != 0;
  battery_mv_ = message.take<std::uint16_t>();
  return (flags & 1) != 0;
}

void ScriptBoard::arrive(std::span<const std::uint8_t> datagram) {
  if (received_ == arrived_) received_ = arrived_ = 0;
  if (arrived_ == arrivals_.size()) return;
  Arrival& arrival = arrivals_[arrived_++];
  arrival.size = std::min(datagram.size(), arrival.bytes.size());
  std::copy_n(datagram.begin(), arrival.size, arrival.bytes.begin());
}

std::uint64_t ScriptBoard::counter_us() { return now_us_ += reading_takes_us; }

bool ScriptBoard::read_imu(NodeSample& sample) {
  sample = reading_;
  return sensor_answers_;
}

bool ScriptBoard::send(std::span<const std::uint8_t> datagram) {
  write_message(line_, radio_takes_ ? 'S' : 'X', datagram);
  return radio_takes_;
}

bool ScriptBoard::receive(std::span<std::uint8_t> room, std::size_t& size) {
  if (received_ == arrived_) return false;
  const Arrival& arrival = arrivals_[received_++];
  size = std::min(arrival.size, room.size());
  std::copy_n(arrival.bytes.begin(), size, room.begin());
  return true;
}

bool ScriptBoard::read_battery(std::uint16_t& mv) {
  mv = battery_mv_;
  return has_battery_;
}

void ScriptBoard::show(const Lights& lights) {
  const std::array<std::uint8_t, 3> shown{static_cast<std::uint8_t>(lights.link_up ? 1 : 0),
                                          static_cast<std::uint8_t>(lights.sync),
                                          static_cast<std::uint8_t>(lights.battery)};
  write_message(line_, 'L', shown);
}

}  // namespace kinalign
