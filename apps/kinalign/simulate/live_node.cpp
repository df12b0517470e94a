// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/simulate/live_node.h"

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

constexpr double frame_rate_hz = 15.0;  // as the firmware sends

/// The settings of a simulated node. All that are not set here are the firmware's defaults.
NodeSettings settings_of(const LiveNodeOptions& options) {
  NodeSettings settings;
  settings.node_id = options.id;
  settings.boot_id = options.boot_id;
  return settings;
}

}  // namespace

/// Both kinds of node run the firmware's own code. A node without a counter sends each sample as
/// one request.
LiveNode::LiveNode(const SimulatedNode& node, const LiveNodeOptions& options, ClockReader& clock,
                   LiveSocket socket)
    : samples_(node),
      clock_(clock),
      start_(options.start),
      counter_(node.seed, options.length_s),
      socket_(std::move(socket)),
      // Both directions have the same seed; `way` gives them different random numbers.
      up_({.link = options.link}, node.seed, Way::up, frame_rate_hz),
      down_({.link = options.link}, node.seed, Way::down, frame_rate_hz) {
  if (options.clockless) {
    node_.emplace<ClocklessNode>(*this, settings_of(options)).set_link(true);
  } else {
    node_.emplace<Node>(*this, settings_of(options)).set_link(true);
  }
}

/// Does the node's work in this order: datagrams that have arrived, samples that are due, the
/// firmware's poll(), datagrams that leave the simulated radio. While a sample is taken,
/// counter_us() returns the sample's own time. A late wake-up therefore does not shift a sample.
void LiveNode::work() {
  std::array<std::uint8_t, max_node_datagram> room{};
  // Datagrams from the host enter the simulated radio here. The node receives them after the
  // radio's delay.
  while (const std::size_t size = socket_.receive(room)) {
    down_.put(clock_.raw(), std::span(room).first(size));
  }
  auto* counting = std::get_if<Node>(&node_);
  auto* clockless = std::get_if<ClocklessNode>(&node_);
  // Samples are taken before poll(), because poll() puts them into frames.
  sampling_ = true;
  while (sample_due(counter_at(clock_.raw()))) {
    if (counting != nullptr) counting->tick(1);
    if (clockless != nullptr) clockless->tick(1);
    ++next_sample_;
  }
  sampling_ = false;
  if (counting != nullptr) counting->poll();
  if (clockless != nullptr) clockless->poll();
  // After the radio's delay a datagram goes to the host over the real network.
  while (const auto datagram = up_.take(clock_.raw())) (void)socket_.send(*datagram);
}

/// The time at which work() must be called next.
HostTime LiveNode::next() const {
  // It is the earliest of three times: a datagram leaves the radio, the firmware has work, a sample
  // is due.
  const std::uint64_t now_us = counter_at(clock_.raw());
  HostTime next = std::min(up_.next(), down_.next());
  if (const auto* counting = std::get_if<Node>(&node_)) {
    next = std::min(next, host_at(now_us + counting->idle_us(now_us)));
  }
  if (next_sample_ < samples_.samples.size()) {
    next = std::min(next, host_at(samples_.samples[next_sample_].counter_us));
  }
  return next;
}

/// The counts of either kind of node. Each request of a node without a counter has one sample.
LiveNodeCounts LiveNode::counts() {
  LiveNodeCounts counts;
  if (auto* counting = std::get_if<Node>(&node_)) {
    const NodeTally tally = counting->counts();
    counts.sent = tally.frames.sent;
    counts.samples = tally.frames.samples_sent;
    counts.answered = tally.replies.accepted;
  }
  if (const auto* clockless = std::get_if<ClocklessNode>(&node_)) {
    counts.sent = counts.samples = clockless->counts().requests;
    counts.answered = clockless->counts().answers.accepted;
  }
  return counts;
}

std::uint64_t LiveNode::counter_at(HostTime t) const {
  return static_cast<std::uint64_t>(counter_.reading(seconds(t - start_)) * 1e6);
}

/// The host's time at which the counter has this value, plus 1 us so that the counter has surely
/// reached it.
HostTime LiveNode::host_at(std::uint64_t counter_us) const {
  const double s = counter_.host(static_cast<double>(counter_us) * 1e-6);
  return start_ + from_seconds(s) + std::chrono::microseconds(1);
}

std::uint64_t LiveNode::counter_us() {
  // The firmware reads the counter while it takes a sample. It must then read the time for which
  // the sample was simulated.
  return sampling_ ? samples_.samples[next_sample_].counter_us : counter_at(clock_.raw());
}

bool LiveNode::read_imu(NodeSample& sample) {
  sample = samples_.samples[next_sample_].sample;
  return true;
}

// The simulated radio accepts every datagram and may lose it later.
bool LiveNode::send(std::span<const std::uint8_t> datagram) {
  up_.put(clock_.raw(), datagram);
  return true;
}

bool LiveNode::receive(std::span<std::uint8_t> room, std::size_t& size) {
  const auto datagram = down_.take(clock_.raw());
  if (!datagram) return false;
  size = std::min(room.size(), datagram->size());
  std::copy_n(datagram->begin(), size, room.begin());
  return true;
}

}  // namespace kinalign
