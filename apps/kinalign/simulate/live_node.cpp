// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/simulate/live_node.h"

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

constexpr double frame_rate_hz = 15.0;  // the firmware's

/// All other settings are the firmware's defaults.
NodeSettings settings_of(const LiveNodeOptions& options) {
  NodeSettings settings;
  settings.node_id = options.id;
  settings.boot_id = options.boot_id;
  return settings;
}

}  // namespace

/// A clockless node sends each sample in a request of its own; both kinds run the firmware's logic.
LiveNode::LiveNode(const SimulatedNode& node, const LiveNodeOptions& options, ClockReader& clock,
                   LiveSocket socket)
    : samples_(node),
      clock_(clock),
      start_(options.start),
      counter_(node.seed, options.length_s),
      socket_(std::move(socket)),
      // The same seed in both directions is no mistake: `way` separates their random numbers.
      up_({.link = options.link}, node.seed, Way::up, frame_rate_hz),
      down_({.link = options.link}, node.seed, Way::down, frame_rate_hz) {
  if (options.clockless) {
    node_.emplace<ClocklessNode>(*this, settings_of(options)).set_link(true);
  } else {
    node_.emplace<Node>(*this, settings_of(options)).set_link(true);
  }
}

/// Runs the node: arrived datagrams, due samples, the firmware's poll, and datagrams at the end of
/// the link. While a sample is taken, counter_us() gives the sample's own time, so waking up late
/// does not shift it.
void LiveNode::work() {
  std::array<std::uint8_t, max_node_datagram> room{};
  // Datagrams of the host enter the simulated radio first. The node receives them when they leave
  // it.
  while (const std::size_t size = socket_.receive(room)) {
    down_.put(clock_.raw(), std::span(room).first(size));
  }
  auto* counting = std::get_if<Node>(&node_);
  auto* clockless = std::get_if<ClocklessNode>(&node_);
  // Samples are taken before poll(), which puts them into frames.
  sampling_ = true;
  while (sample_due(counter_at(clock_.raw()))) {
    if (counting != nullptr) counting->tick(1);
    if (clockless != nullptr) clockless->tick(1);
    ++next_sample_;
  }
  sampling_ = false;
  if (counting != nullptr) counting->poll();
  if (clockless != nullptr) clockless->poll();
  // The radio's delay is over: the datagram now goes to the host over the real network.
  while (const auto datagram = up_.take(clock_.raw())) (void)socket_.send(*datagram);
}

/// The earliest time at which work() has something to do.
HostTime LiveNode::next() const {
  // Three kinds of work can come next: a datagram that arrives, the firmware's own work, and a
  // sample.
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

/// The counts of either kind of node. A request of a clockless node has one sample.
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

/// The host's time of a counter value, with 1 us added, so that the counter has reached it.
HostTime LiveNode::host_at(std::uint64_t counter_us) const {
  const double s = counter_.host(static_cast<double>(counter_us) * 1e-6);
  return start_ + from_seconds(s) + std::chrono::microseconds(1);
}

std::uint64_t LiveNode::counter_us() {
  // During a sample the firmware reads the counter, and it must read the time for which the sample
  // was made.
  return sampling_ ? samples_.samples[next_sample_].counter_us : counter_at(clock_.raw());
}

bool LiveNode::read_imu(NodeSample& sample) {
  sample = samples_.samples[next_sample_].sample;
  return true;
}

// The simulated radio always accepts. A loss is found only at its end.
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
