// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): stream 4 of a seed has these lanes: 0 the variation of sending times,
// 1 the host's turnaround, 2 the node's. Stream 5 gives the boot ids.
#include "kinalign/simulate/nodes/exchanges.h"

#include "kinalign/simulate/random.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// Greatest variation of sending times and of the node's answers.
constexpr double dither_s = 1e-3;
constexpr double turnaround_s = 30e-6;  // host's mean time from a frame's arrival to its reply

/// The node's counter with all steps, reboots and changes of rate. The crystal runs through all of
/// them; a boot only sets the count to zero.
class Counter {
 public:
  Counter(std::uint64_t seed, const ExchangeOptions& options)
      : options_(options), clock_(seed, options.length_s, options.clock), ids_(seed, 5) {}

  struct Reading {
    std::uint32_t boot_id;
    double seconds;
  };

  /// Returns false from a loss of power until the next start.
  bool powered(double t) const {
    return std::none_of(options_.reboots.begin(), options_.reboots.end(),
                        [&](const Reboot& r) { return t >= r.at && t < r.at + r.gap; });
  }

  /// Returns the reading at true time t. Steps and changes of rate before the current boot have no
  /// effect.
  Reading at(double t) const {
    std::uint64_t id = 0;
    double begin = -1.0;  // start of the current boot
    for (std::size_t i = 0; i < options_.reboots.size() && options_.reboots[i].at <= t; ++i) {
      begin = options_.reboots[i].at + options_.reboots[i].gap;
      if (!options_.reboots[i].same_id) id = i + 1;
    }
    double seconds = clock_.reading(t);
    if (begin >= 0.0) seconds -= clock_.reading(begin);
    for (const CounterStep& step : options_.steps) {
      if (step.at > begin && step.at <= t) seconds += step.by;
    }
    for (const RateStretch& stretch : options_.stretches) {
      const double from = std::max(stretch.begin, begin), to = std::min(stretch.end, t);
      if (to > from) seconds += stretch.rate * (to - from);
    }
    return {
        static_cast<std::uint32_t>(mix64(static_cast<std::uint64_t>(ids_.uniform(id, 0) * 0x1p53))),
        seconds};
  }

 private:
  const ExchangeOptions& options_;
  SimulatedClock clock_;
  RandomStream ids_;
};

// A counter shows completed microseconds.
std::int64_t microseconds(double seconds) {
  return static_cast<std::int64_t>(std::floor(seconds * 1e6));
}

/// Fills the frames with the node's readings. The sequence number begins again after a reboot.
void send_frames(const Counter& counter, std::uint64_t seed, SimulatedExchanges& run) {
  const ExchangeOptions& o = run.options;
  const RandomStream random(seed, 4);
  const auto planned = static_cast<std::uint64_t>(o.length_s * o.rate_hz);
  std::uint32_t sequence = 0;
  bool was_off = false;
  for (std::uint64_t k = 0; k < planned; ++k) {
    SimulatedFrame frame;
    frame.sent = (static_cast<double>(k) + 0.5) / o.rate_hz + dither_s * random.uniform(k, 0);
    const Counter::Reading reading = counter.at(frame.sent);
    // A restart without a new boot id is recognised too, because the counter then falls by more
    // than a second.
    const bool restarted =
        !run.frames.empty() &&
        (was_off || run.frames.back().boot_id != reading.boot_id ||
         reading.seconds * 1e6 + 1e6 < static_cast<double>(run.frames.back().n_tx_us));
    // A node without power sends nothing.
    was_off = !counter.powered(frame.sent);
    if (was_off) continue;
    if (restarted) sequence = 0;
    frame.boot_id = reading.boot_id;
    frame.sequence = sequence++;
    frame.n_tx_us = microseconds(reading.seconds);
    // The counter is truncated to microseconds. The truth is the time of the middle of the
    // microsecond.
    frame.truth = frame.sent + static_cast<double>(frame.n_tx_us) * 1e-6 + 0.5e-6 - reading.seconds;
    run.frames.push_back(frame);
  }
}

/// Sends the frames to the host. Returns the indices of the frames that arrive, in the order of
/// arrival.
std::vector<std::size_t> carry_up(std::uint64_t seed, SimulatedExchanges& run) {
  std::vector<double> sent(run.frames.size());
  for (std::size_t k = 0; k < sent.size(); ++k) sent[k] = run.frames[k].sent;
  const auto arrivals = transmit(run.options.link, seed, Way::up, sent);
  std::vector<std::size_t> arrival;
  for (std::size_t k = 0; k < sent.size(); ++k) {
    run.frames[k].arrival = arrivals[k].first;
    run.frames[k].second_arrival = arrivals[k].duplicate;
    if (arrivals[k].first) arrival.push_back(k);
  }
  std::stable_sort(arrival.begin(), arrival.end(), [&](std::size_t a, std::size_t b) {
    return *run.frames[a].arrival < *run.frames[b].arrival;
  });
  return arrival;
}

/// Sends a reply to each frame that arrived. The node reads its counter when a reply arrives. A
/// reply that arrives while the node is off or after a reboot has no effect.
void carry_down(const Counter& counter, std::uint64_t seed, const std::vector<std::size_t>& arrival,
                SimulatedExchanges& run) {
  const RandomStream random(seed, 4);
  std::vector<double> sent(arrival.size());
  double last = 0.0;
  for (std::size_t j = 0; j < arrival.size(); ++j) {
    // The host answers one frame after another.
    last = std::max(last, *run.frames[arrival[j]].arrival + random.exponential(j, 1, turnaround_s));
    sent[j] = run.frames[arrival[j]].replied = last;
  }
  const auto arrivals = transmit(run.options.link, seed, Way::down, sent);
  for (std::size_t j = 0; j < arrival.size(); ++j) {
    SimulatedFrame& frame = run.frames[arrival[j]];
    if (!arrivals[j].first || !counter.powered(*arrivals[j].first)) continue;
    const Counter::Reading reading = counter.at(*arrivals[j].first);
    if (reading.boot_id != frame.boot_id) continue;  // the reply was sent to an earlier boot
    frame.reply_arrival = arrivals[j].first;
    frame.n_rx_us = microseconds(reading.seconds);
  }
}

/// Sets the echoes: each frame contains the newest reply since the previous frame.
void echo_replies(SimulatedExchanges& run) {
  auto& frames = run.frames;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (!frames[k].reply_arrival) continue;
    const auto next =
        std::upper_bound(frames.begin(), frames.end(), *frames[k].reply_arrival,
                         [](double t, const SimulatedFrame& frame) { return t <= frame.sent; });
    if (next == frames.end() || next->boot_id != frames[k].boot_id) continue;
    if (!next->echo || frames[k].replied > frames[*next->echo].replied) next->echo = k;
  }
}

/// Simulates the third packet of the exchange in the HFUT-MMD paper, which a node without a clock
/// sends.
void confirm(std::uint64_t seed, SimulatedExchanges& run) {
  const RandomStream random(seed, 4);
  std::vector<std::pair<double, std::size_t>> answers;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    if (!run.frames[k].reply_arrival) continue;
    answers.emplace_back(*run.frames[k].reply_arrival + dither_s * random.uniform(k, 2), k);
  }
  std::sort(answers.begin(), answers.end());
  std::vector<double> sent(answers.size());
  for (std::size_t j = 0; j < sent.size(); ++j) sent[j] = answers[j].first;
  const auto arrivals = transmit(run.options.link, seed, Way::confirm, sent);
  for (std::size_t j = 0; j < sent.size(); ++j) {
    run.frames[answers[j].second].confirmed = arrivals[j].first;
  }
}

}  // namespace

// The steps have the order of the packets: frame, reply, echo in a later frame. The last step
// simulates the third packet of the HFUT-MMD paper for the same exchanges.
SimulatedExchanges simulate_exchanges(const ExchangeOptions& options, std::uint64_t seed) {
  SimulatedExchanges run{options, floors(options.link.link, seed), {}};
  const Counter counter(seed, run.options);
  send_frames(counter, seed, run);
  const auto arrival = carry_up(seed, run);
  carry_down(counter, seed, arrival, run);
  echo_replies(run);
  confirm(seed, run);
  return run;
}

std::vector<ArrivedFrame> in_order_of_arrival(const SimulatedExchanges& exchanges) {
  std::vector<ArrivedFrame> arrival;
  for (std::size_t k = 0; k < exchanges.frames.size(); ++k) {
    const SimulatedFrame& frame = exchanges.frames[k];
    if (frame.arrival) arrival.push_back({*frame.arrival, k, false});
    if (frame.second_arrival) arrival.push_back({*frame.second_arrival, k, true});
  }
  std::stable_sort(arrival.begin(), arrival.end(),
                   [](const ArrivedFrame& a, const ArrivedFrame& b) { return a.at < b.at; });
  return arrival;
}

}  // namespace kinalign
