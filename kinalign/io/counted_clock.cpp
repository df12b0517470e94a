// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/counted_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// Chosen: further back than any network reorders, or an hour ahead at 100 Hz, is another count.
constexpr std::int64_t furthest_back = 1000, furthest_ahead = 360'000;
constexpr double believed = 0.01;            // of a step: Noitom's programs state three decimals
constexpr std::int64_t enough_frames = 100;  // to contradict what is stated
// Chosen: an arrival late by 20 ms is 0.4 % of it, and a recording of a minute has eleven.
constexpr Duration window = std::chrono::seconds(5);
constexpr double slowest_step_ns = 2e9;  // so that no number of 32 bits overflows its counter

/// The median over windows of some seconds within a life: a pause in which the device did not
/// count is in one of them. 0 where nothing was sent twice.
double measured_step_ns(const std::vector<CountedFrame>& frames) {
  std::vector<double> steps, short_ones;
  for (std::size_t begin = 0, end = 1; end < frames.size(); ++end) {
    const CountedFrame &first = frames[begin], &last = frames[end];
    if (last.life != first.life) {
      begin = end;
      continue;
    }
    const auto count = last.number - first.number;
    if (count <= 0) continue;
    const double step =
        static_cast<double>((last.arrival - first.arrival).count()) / static_cast<double>(count);
    const bool last_of_life = end + 1 == frames.size() || frames[end + 1].life != last.life;
    if (last.arrival - first.arrival >= window) {
      steps.push_back(step);
      begin = end;
    } else if (last_of_life) {
      short_ones.push_back(step);
    }
  }
  std::vector<double>& all = steps.empty() ? short_ones : steps;
  if (all.empty()) return 0.0;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return std::clamp(*middle, 0.0, slowest_step_ns);
}

std::string rate_text(double step_ns) { return fmt::format("{:.6g} Hz", 1e9 / step_ns); }

}  // namespace

CountedFrame FrameNumbers::place(std::uint32_t number, HostTime arrival) {
  const auto ahead = static_cast<std::int32_t>(number - static_cast<std::uint32_t>(last_));
  if (begins_ || ahead < -furthest_back || ahead > furthest_ahead) {
    ++life_;
    last_ = number;
  } else {
    last_ += ahead;
  }
  begins_ = false;
  return {life_, last_, arrival};
}

NodeTime counter_of(const CountedFrame& frame, double step_ns) {
  return NodeTime{Duration{std::llround(step_ns * static_cast<double>(frame.number))}};
}

CountedClock counted_clock(const std::vector<CountedFrame>& frames, double stated_step_ns,
                           Duration utc_minus_host, const std::string& file) {
  CountedClock out;
  const double measured = measured_step_ns(frames);
  out.step_ns = stated_step_ns > 0.0 ? stated_step_ns : measured;
  const bool many = static_cast<std::int64_t>(frames.size()) > enough_frames;
  if (stated_step_ns > 0.0 && many && std::abs(measured / stated_step_ns - 1.0) > believed) {
    out.step_ns = measured;
    out.findings.push_back({Severity::warning,
                            Error{file, 0, rate_text(stated_step_ns) + ", as stated",
                                  "frames that arrive at " + rate_text(measured)},
                            "stamps were counted by the rate at which they arrive",
                            "state the true rate: rate_hz"});
  }
  std::vector<Exchange> exchanges;
  exchanges.reserve(frames.size());
  for (const CountedFrame& frame : frames) {
    exchanges.push_back({frame.life, counter_of(frame, out.step_ns), frame.arrival, {}});
  }
  out.clock = device_clock(exchanges, utc_minus_host);
  return out;
}

}  // namespace kinalign
