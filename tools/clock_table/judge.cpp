// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/judge.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

HostTime arrival_time(double seconds) {
  return HostTime{Duration{static_cast<std::int64_t>(std::ceil(seconds * 1e9))}};
}

HostTime departure_time(double seconds) {
  return HostTime{Duration{static_cast<std::int64_t>(std::floor(seconds * 1e9))}};
}

NodeTime counter_time(std::int64_t microseconds) { return NodeTime{Duration{1000 * microseconds}}; }

double seconds_of(HostTime t) { return seconds(t.time_since_epoch()); }

std::uint64_t JudgedRun::count(ClockEvent::Kind kind) const {
  return static_cast<std::uint64_t>(std::count_if(
      events.begin(), events.end(), [kind](const ClockEvent& e) { return e.kind == kind; }));
}

std::uint64_t JudgedRun::lies() const {
  return static_cast<std::uint64_t>(
      std::count_if(stamps.begin(), stamps.end(),
                    [](const JudgedStamp& s) { return s.certified && !s.withdrawn && s.outside; }));
}

namespace {

JudgedStamp judged(const ClockStamp& stamp, const SimulatedFrame& frame, double arrival) {
  JudgedStamp out;
  out.sent = frame.sent;
  out.arrival = arrival;
  out.error = seconds_of(stamp.time) - frame.truth;
  out.certified = stamp.certainty == Certainty::certified;
  const bool early = stamp.earliest && *stamp.earliest > arrival_time(frame.sent);
  const bool late = stamp.latest && *stamp.latest < departure_time(frame.sent);
  out.outside = early || late;
  if (stamp.earliest && stamp.latest)
    out.half_width = seconds(*stamp.latest - *stamp.earliest) / 2.0;
  return out;
}

void withdraw(const ClockEvent& event, std::vector<JudgedStamp>& stamps) {
  for (JudgedStamp& stamp : stamps) {
    const HostTime arrival = arrival_time(stamp.arrival);
    if (arrival >= event.begin && arrival <= event.end) stamp.withdrawn = true;
  }
}

/// The simulated frames that belong to exchanges_of(), in the same order.
std::vector<std::size_t> arrived_frames(const SimulatedExchanges& exchanges) {
  std::vector<std::size_t> frames;
  for (const ArrivedFrame& arrived : in_order_of_arrival(exchanges)) {
    if (!arrived.again) frames.push_back(arrived.frame);
  }
  return frames;
}

Exchange exchange_of(const SimulatedExchanges& exchanges, const SimulatedFrame& frame) {
  Exchange exchange{frame.boot_id, counter_time(frame.n_tx_us), arrival_time(*frame.arrival), {}};
  if (frame.echo) {
    const SimulatedFrame& answered = exchanges.frames[*frame.echo];
    exchange.echo = {counter_time(answered.n_rx_us), departure_time(answered.replied)};
  }
  return exchange;
}

JudgedRun judged_run(const SimulatedExchanges& exchanges) {
  JudgedRun run;
  run.asymmetry = (exchanges.floors.up - exchanges.floors.down) / 2.0;
  return run;
}

}  // namespace

std::vector<Exchange> exchanges_of(const SimulatedExchanges& exchanges) {
  std::vector<Exchange> out;
  for (const std::size_t frame : arrived_frames(exchanges)) {
    out.push_back(exchange_of(exchanges, exchanges.frames[frame]));
  }
  return out;
}

JudgedRun judge_live(const SimulatedExchanges& exchanges, const Assumptions& assumptions) {
  JudgedRun run = judged_run(exchanges);
  LiveClock clock(assumptions);
  for (const std::size_t k : arrived_frames(exchanges)) {
    const SimulatedFrame& frame = exchanges.frames[k];
    const Exchange exchange = exchange_of(exchanges, frame);
    ++run.frames;
    clock.push(exchange);
    const auto stamp = clock.host_from_node(exchange.boot, exchange.n_tx);
    for (const ClockEvent& event : clock.take_events()) {
      if (event.kind == ClockEvent::Kind::withdrawn) withdraw(event, run.stamps);
      run.events.push_back(event);
    }
    if (stamp) run.stamps.push_back(judged(*stamp, frame, *frame.arrival));
  }
  return run;
}

JudgedRun judge_offline(const SimulatedExchanges& exchanges, const Assumptions& assumptions) {
  JudgedRun run = judged_run(exchanges);
  const std::vector<Exchange> received = exchanges_of(exchanges);
  const OfflineClock clock = fit_offline_clock(received, assumptions);
  run.events = clock.events;
  const std::vector<std::size_t> frames = arrived_frames(exchanges);
  run.frames = frames.size();
  for (std::size_t i = 0; i < received.size(); ++i) {
    const auto stamp =
        host_from_node(clock.model, received[i].boot, received[i].n_tx, received[i].h_rx);
    const SimulatedFrame& frame = exchanges.frames[frames[i]];
    if (stamp) run.stamps.push_back(judged(*stamp, frame, *frame.arrival));
  }
  return run;
}

ErrorFigures figures(std::vector<double> errors) {
  if (errors.empty()) return {};
  double squares = 0.0;
  for (double& e : errors) {
    e = std::abs(e);
    squares += e * e;
  }
  std::sort(errors.begin(), errors.end());
  const auto n = errors.size();
  return {std::sqrt(squares / static_cast<double>(n)), errors[std::min(n - 1, n * 99 / 100)],
          errors.back()};
}

std::vector<double> errors_since(const JudgedRun& run, double begin, double asymmetry) {
  std::vector<double> errors;
  for (const JudgedStamp& stamp : run.stamps) {
    if (stamp.sent >= begin) errors.push_back(stamp.error - asymmetry);
  }
  return errors;
}

}  // namespace kinalign
