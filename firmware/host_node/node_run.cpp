// SPDX-License-Identifier: Apache-2.0
#include "firmware/host_node/node_run.h"

#include "firmware/node/count_names.h"

#include <poll.h>

#include <algorithm>
#include <random>

namespace kinalign {

namespace {

std::int64_t ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

std::uint32_t random_boot_id() {
  std::random_device device;
  return device();
}

std::string server_text(const HostNodeOptions& options) {
  const bool six = options.host.find(':') != std::string::npos;
  return (six ? "[" + options.host + "]" : options.host) + ":" + options.port;
}

std::uint64_t wrong_key(const AnswerCounts& counts) {
  const auto of = [&](NodeRefusal why) { return counts.refused[static_cast<std::size_t>(why)]; };
  return of(NodeRefusal::no_mac) + of(NodeRefusal::wrong_mac);
}

ClockTruth first_truth(const HostNodeOptions& options) {
  const std::uint32_t boot_id = options.has_boot_id ? options.node.boot_id : random_boot_id();
  return {boot_id, raw_ns(), options.offset_s * 1e6, options.drift_ppm};
}

}  // namespace

NodeRun::NodeRun(const HostNodeOptions& options, NodeSocket socket)
    : options_(options),
      socket_(std::move(socket)),
      clock_(first_truth(options)),
      board_(options_, clock_, socket_),
      begin_ns_(clock_.truths().front().raw_ns),
      watch_(server_text(options), options.node.has_key),
      tick_period_us_(1e6 / (options.clockless ? options.rate_hz : options.sample_rate_hz)) {
  boot(clock_.truths().front().boot_id);
}

void NodeRun::boot(std::uint32_t boot_id) {
  past_ = counts();
  NodeSettings settings = options_.node;
  settings.boot_id = boot_id;
  next_tick_us_ = static_cast<double>(board_.counter_us()) + tick_period_us_;
  if (options_.clockless) {
    node_.emplace<ClocklessNode>(board_, settings);
  } else {
    node_.emplace<Node>(board_, settings);
  }
}

Tried<void> NodeRun::befall(const Event& event) {
  const std::int64_t now = raw_ns();
  const std::uint32_t boot_id = clock_.truths().back().boot_id;
  if (event.kind == EventKind::outage_begins) link_up_ = false;
  if (event.kind == EventKind::outage_ends) link_up_ = true;
  if (event.kind == EventKind::drift) clock_.set_drift(now, event.value);
  if (event.kind == EventKind::step) {
    clock_.step(now, event.value);
    next_tick_us_ += event.value * 1e6;  // the sample timer does not step with the counter
  }
  if (event.kind == EventKind::reboot) {
    clock_.reboot(now, options_.same_boot_id ? boot_id : random_boot_id());
    boot(clock_.truths().back().boot_id);
    ++past_.reboots;
  }
  if (event.kind == EventKind::rebind) {
    auto socket = NodeSocket::connected_to(options_.host, options_.port);
    if (!socket) return tl::unexpected(socket.error());
    socket_ = *std::move(socket);
  }
  return {};
}

std::uint32_t NodeRun::ticks_due() {
  const double now_us = static_cast<double>(board_.counter_us());
  std::uint32_t due = 0;
  for (; next_tick_us_ <= now_us; next_tick_us_ += tick_period_us_) ++due;
  return due;
}

void NodeRun::tick_and_poll() {
  const std::uint32_t due = ticks_due();
  if (auto* node = std::get_if<Node>(&node_)) {
    node->set_link(link_up_);
    node->tick(due);
    node->poll();
  }
  if (auto* node = std::get_if<ClocklessNode>(&node_)) {
    node->set_link(link_up_);
    node->tick(due);
    node->poll();
  }
}

std::int64_t NodeRun::idle_ns() {
  const std::uint64_t now_us = board_.counter_us();
  double idle_us = next_tick_us_ - static_cast<double>(now_us);
  if (auto* node = std::get_if<Node>(&node_)) {
    idle_us = std::min(idle_us, static_cast<double>(node->idle_us(now_us)));
  }
  return std::clamp(ns(idle_us * 1e-6), std::int64_t{0}, std::int64_t{100'000'000});
}

void NodeRun::watch(std::int64_t age_ns, const PrintLine& print_line) {
  if (age_ns < next_watch_ns_) return;
  next_watch_ns_ = age_ns + ns(0.25);
  const RunCounts now = counts();
  const AnswerCounts &replies = now.node.replies, &answers = now.clockless.answers;
  const std::string line = watch_.look(age_ns, replies.accepted + answers.accepted,
                                       wrong_key(replies) + wrong_key(answers));
  if (!line.empty()) print_line(line);
}

Tried<void> NodeRun::live(int stop, const PrintLine& print_line) {
  for (;;) {
    const std::int64_t age = raw_ns() - begin_ns_;
    if (options_.seconds > 0 && age >= ns(options_.seconds)) return {};
    while (next_event_ < options_.events.size() && ns(options_.events[next_event_].at_s) <= age) {
      if (auto befallen = befall(options_.events[next_event_++]); !befallen) return befallen;
    }
    tick_and_poll();
    watch(age, print_line);
    const timespec idle{0, idle_ns()};
    std::array<pollfd, 2> watched{{{socket_.descriptor(), POLLIN, 0}, {stop, POLLIN, 0}}};
    ppoll(watched.data(), watched.size(), &idle, nullptr);
    if (watched[1].revents != 0) return {};
  }
}

RunCounts NodeRun::counts() {
  RunCounts sum = past_;
  std::vector<std::uint64_t> now;  // in the order of count_names.h
  const auto list = [&](const char*, std::uint64_t number) { now.push_back(number); };
  auto next = now.begin();
  const auto add = [&](const char*, std::uint64_t& number) { number += *next++; };
  if (auto* node = std::get_if<Node>(&node_)) {
    const NodeTally counts = node->counts();
    each_node_count(counts, list);
    next = now.begin();
    each_node_count(sum.node, add);
  }
  if (auto* node = std::get_if<ClocklessNode>(&node_)) {
    each_clockless_count(node->counts(), list);
    next = now.begin();
    each_clockless_count(sum.clockless, add);
  }
  return sum;
}

}  // namespace kinalign
