// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/node_sample.h"

namespace kinalign {

namespace {

constexpr std::uint8_t acceleration_flag = 1, angular_velocity_flag = 2, orientation_flag = 4,
                       gravity_flag = 8;

std::uint8_t flags_of(const NodeSample& sample) {
  return static_cast<std::uint8_t>(
      (sample.has_acceleration ? acceleration_flag : 0) |
      (sample.has_angular_velocity ? angular_velocity_flag : 0) |
      (sample.has_orientation ? orientation_flag : 0) |
      (sample.has_acceleration && sample.gravity_included ? gravity_flag : 0));
}

/// True if all flags are known. The gravity flag without an acceleration counts as unknown.
bool known(std::uint8_t flags) {
  // Gravity is a property of the acceleration, so the flag has no meaning without one.
  const bool gravity_of_nothing = (flags & gravity_flag) != 0 && (flags & acceleration_flag) == 0;
  return flags < 2 * gravity_flag && !gravity_of_nothing;
}

void put(ByteWriter& writer, std::span<const float> values) {
  for (const float value : values) writer.put_float(value);
}

void take(ByteReader& reader, std::span<float> values) {
  for (float& value : values) value = reader.take_float();
}

// Tests the exponent's bits, because <cmath> is not part of a freestanding library.
bool finite(std::span<const float> values) {
  for (const float value : values) {
    if ((std::bit_cast<std::uint32_t>(value) & 0x7f800000) == 0x7f800000) return false;
  }
  return true;
}

}  // namespace

SampleFaults faults(const NodeSample& sample) {
  const bool all_finite = (!sample.has_acceleration || finite(sample.acceleration)) &&
                          (!sample.has_angular_velocity || finite(sample.angular_velocity)) &&
                          (!sample.has_orientation || finite(sample.orientation));
  const bool zero = sample.orientation == std::array<float, 4>{};
  return {!all_finite, sample.has_orientation && zero};
}

std::size_t encoded_size(const NodeSample& sample) {
  // Age (4 bytes) and flags (1 byte), then the vectors and the quaternion that are present.
  return 4U + 1U + (sample.has_acceleration ? 12U : 0U) + (sample.has_angular_velocity ? 12U : 0U) +
         (sample.has_orientation ? 16U : 0U);
}

void put_sample(ByteWriter& writer, const NodeSample& sample) {
  writer.put(sample.age_us);
  writer.put(flags_of(sample));
  if (sample.has_acceleration) put(writer, sample.acceleration);
  if (sample.has_angular_velocity) put(writer, sample.angular_velocity);
  if (sample.has_orientation) put(writer, sample.orientation);
}

bool take_sample(ByteReader& reader, NodeSample& sample) {
  sample.age_us = reader.take<std::uint32_t>();
  const auto flags = reader.take<std::uint8_t>();
  // The flags determine which fields follow. If a flag is unknown, the rest can't be read.
  if (!known(flags)) return false;
  sample.has_acceleration = (flags & acceleration_flag) != 0;
  sample.has_angular_velocity = (flags & angular_velocity_flag) != 0;
  sample.has_orientation = (flags & orientation_flag) != 0;
  sample.gravity_included = (flags & gravity_flag) != 0;
  if (sample.has_acceleration) take(reader, sample.acceleration);
  if (sample.has_angular_velocity) take(reader, sample.angular_velocity);
  if (sample.has_orientation) take(reader, sample.orientation);
  return true;
}

}  // namespace kinalign
