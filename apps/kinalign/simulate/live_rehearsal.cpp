// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/simulate/live_rehearsal.h"

#include <poll.h>
#include <sys/prctl.h>

#include <algorithm>

namespace kinalign {

namespace {

using namespace std::chrono_literals;

constexpr Duration after_motion = 500ms;  // for datagrams that are still on their way
constexpr Duration longest_wait = 100ms;  // between two calls of go_on

// Noitom's stream always has this number of joints.
constexpr std::size_t noitom_joints = 59;

/// The present time of the raw clock and of UTC, plus `wait`. The raw clock is read before and
/// after UTC, and the mean of both readings is used.
ClockPair begin_after(ClockReader& clock, Duration wait) {
  const HostTime before = clock.raw();
  const Time utc = clock.utc();
  const HostTime after = clock.raw();
  return {before + (after - before) / 2 + wait, utc + wait};
}

}  // namespace

LiveTraffic LiveCounts::all() const {
  LiveTraffic all;
  for (const LiveTraffic& one : {mocap, kinect, nodes, clicks}) all += one;
  return all;
}

Result<LiveSockets> open_live(const LiveOptions& options, std::size_t nodes) {
  const auto connected = [&](std::int64_t port) {
    return LiveSocket::connected_to(options.to, static_cast<std::uint16_t>(port));
  };
  // All sockets are opened before the first datagram is sent, so that no run begins with only some
  // devices.
  LiveSockets sockets{KA_TRY(connected(options.mocap_port)),
                      KA_TRY(connected(options.kinect_port)),
                      KA_TRY(connected(options.marks_port)),
                      {}};
  for (std::size_t n = 0; n < nodes; ++n) {
    sockets.nodes.push_back(KA_TRY(connected(options.node_port)));
  }
  return sockets;
}

Result<void> check_live(const Motion& motion, const std::string& name) {
  const std::size_t joints = motion.skeleton.joints();
  if (joints == noitom_joints) return {};
  return Failure(Error{name, 0,
                       "a suit's skeleton with the 59 joints of Noitom's stream, for --live",
                       std::to_string(joints) + " joints"});
}

LiveRehearsal::LiveRehearsal(const Motion& motion, const Rehearsal& rehearsal,
                             const LiveOptions& options, ClockReader& clock, LiveSockets sockets)
    : clock_(&clock),
      start_(begin_after(clock, from_seconds(options.begin_in_s))),
      length_s_(motion.length_s) {
  const HostTime start = start_.raw;
  // Each run gets new ids, as a real device draws new ids at each start.
  const std::uint64_t run = mix64(static_cast<std::uint64_t>(start.time_since_epoch().count()));
  suit_ = std::make_unique<LiveSuit>(motion, rehearsal.mocap, options.seed, start,
                                     std::move(sockets.mocap));
  camera_ = std::make_unique<LiveCamera>(
      rehearsal,
      LiveCameraOptions{options.seed, static_cast<std::uint32_t>(run), start, motion.length_s},
      clock, std::move(sockets.kinect));
  // The number `run` becomes part of the marks' ids, the Kinect's session and the nodes' boot ids.
  clicks_ = std::make_unique<LiveClicks>(rehearsal.mocap, run, start, std::move(sockets.clicks));
  for (std::size_t n = 0; n < rehearsal.nodes.size(); ++n) {
    LiveNodeOptions node{.id = static_cast<std::uint32_t>(n + 1),
                         .boot_id = static_cast<std::uint32_t>(mix64(run + n)),
                         .link = options.link,
                         .clockless = options.clockless,
                         .start = start,
                         .length_s = motion.length_s};
    // A node refers to its samples; they belong to the rehearsal and must live longer.
    nodes_.push_back(
        std::make_unique<LiveNode>(rehearsal.nodes[n], node, clock, std::move(sockets.nodes[n])));
  }
}

/// Runs all devices in one thread until the motion ends.
double LiveRehearsal::run(const std::function<bool()>& go_on) {
  ::prctl(PR_SET_TIMERSLACK, 1000UL);  // ns; the default of 50 us would delay wake-ups
  const HostTime end = start_.raw + from_seconds(length_s_) + after_motion;
  while (clock_->raw() < start_.raw) {  // a node's counter begins at the start
    if (!go_on()) return 0.0;
    wait(std::min(start_.raw, clock_->raw() + longest_wait));
  }
  for (HostTime now = clock_->raw(); now < end; now = clock_->raw()) {
    // If the user stops the run, the result is the part of the motion that was sent.
    if (!go_on()) return std::min(seconds(now - start_.raw), length_s_);
    suit_->work(now);
    camera_->work();
    clicks_->work(now);
    for (const auto& node : nodes_) node->work();
    HostTime next =
        // The loop sleeps until the first device has work.
        std::min({end, now + longest_wait, suit_->next(), camera_->next(), clicks_->next()});
    for (const auto& node : nodes_) next = std::min(next, node->next());
    wait(next);
  }
  return length_s_;
}

/// Waits until the time `until` or until a datagram arrives.
void LiveRehearsal::wait(HostTime until) const {
  // Answers to the suit and to the user's clicks are not urgent, so their sockets do not end the
  // wait.
  std::vector<pollfd> received{{camera_->fd(), POLLIN, 0}};
  for (const auto& node : nodes_) received.push_back({node->fd(), POLLIN, 0});
  const Duration left = std::max(until - clock_->raw(), Duration::zero());
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec timeout{whole.count(), (left - whole).count()};
  // ppoll() waits with a resolution of nanoseconds, poll() of milliseconds.
  ::ppoll(received.data(), received.size(), &timeout, nullptr);
}

/// Adds up the counts of all devices.
LiveCounts LiveRehearsal::counts() const {
  LiveCounts counts;
  counts.mocap_frames = suit_->sent();
  counts.kinect_frames = camera_->sent();
  counts.mocap = suit_->traffic();
  counts.kinect = camera_->traffic();
  counts.clicks = clicks_->traffic();
  counts.worst_late = std::max(suit_->worst_late(), camera_->worst_late());
  for (const auto& node : nodes_) {
    const LiveNodeCounts one = node->counts();
    counts.node_frames += one.sent;
    counts.node_samples += one.samples;
    counts.replies += one.answered;
    counts.nodes += node->traffic();
  }
  return counts;
}

/// The truth of a live rehearsal. Its stamps are those that the devices send.
TrueRecording live_truth(const Rehearsal& rehearsal, const Motion& motion, const ClockPair& start,
                         std::optional<double> clockless_hz) {
  // The stamps of truth_of() begin at the start of the recording. The stamps that a device sends
  // begin at its own count.
  TrueRecording truth = truth_of(rehearsal, motion, start.utc);
  truth.host = TrueHost{start.raw.time_since_epoch().count(), to_ns(start.utc)};
  // Shifts the stamps of one device so that they begin at `first`.
  const auto begin_at = [](TrueClock& clock, std::int64_t first) {
    if (clock.stamps_ns.empty()) return;
    const std::int64_t shift = first - clock.stamps_ns.front();
    for (std::int64_t& stamp : clock.stamps_ns) stamp += shift;
  };
  // A tick of the Kinect has 100 ns, a tick of a node's counter 1 us.
  if (!rehearsal.ticks.empty()) begin_at(truth.kinect.clock, 100 * rehearsal.ticks.front().device);
  for (std::size_t n = 0; n < truth.nodes.size(); ++n) {
    const SimulatedNode& node = rehearsal.nodes[n];
    if (clockless_hz) {
      // A node without a counter has no clock. It sends each sample in one request. The stamp is
      // the number of the request, counted from 0, times the sample period.
      truth.nodes[n].clock = {};
      for (std::size_t i = 0; i < node.truth.times.size(); ++i) {
        truth.nodes[n].clock.stamps_ns.push_back(
            std::llround(1e9 / *clockless_hz * static_cast<double>(i)));
        truth.nodes[n].clock.times_ns.push_back(to_ns(time_at(start.utc, node.truth.times[i])));
      }
    } else if (!node.samples.empty()) {
      begin_at(truth.nodes[n].clock,
               1000 * static_cast<std::int64_t>(node.samples.front().counter_us));
    }
  }
  return truth;
}

}  // namespace kinalign
