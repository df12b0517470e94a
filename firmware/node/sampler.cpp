// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/sampler.h"

namespace kinalign {

void Sampler::tick(std::uint32_t due) {
  if (due == 0) return;
  TakenSample taken;
  // Before the reading, so a stamp may be early by the reading's length.
  taken.counter_us = board_.counter_us();
  const bool answered = board_.read_imu(taken.sample);
  if (!answered) taken.sample = {};
  const Locked locked(board_);
  counts_.ticks += due;
  counts_.missed += due - 1;
  ++counts_.taken;
  if (!answered) ++counts_.sensor_fails;
  if (!ring_.push(taken)) ++counts_.dropped;
}

std::size_t Sampler::take(std::span<TakenSample> out) {
  const Locked locked(board_);
  return ring_.pop(out);
}

bool Sampler::full() {
  const Locked locked(board_);
  return ring_.size() == SampleRing::capacity;
}

void Sampler::count_dropped(std::size_t n) {
  const Locked locked(board_);
  counts_.dropped += n;
}

SampleCounts Sampler::counts() {
  const Locked locked(board_);
  return counts_;
}

}  // namespace kinalign
