// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/counted_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// The largest accepted relative deviation from the stated time between frames. Noitom's programs
// state this time with three decimals.
constexpr double believed = 0.01;
constexpr std::int64_t enough_frames = 100;  // needed to contradict the stated time between frames
// Both values are choices. With so many windows, a pause in one window does not matter. A window is
// so long that a delay of a few milliseconds is a thousandth of it.
constexpr int windows = 8;
constexpr Duration shortest_window = std::chrono::milliseconds(500);
constexpr Duration longest_window = std::chrono::seconds(5);
constexpr double slowest_step_ns = 2e9;  // prevents an overflow of the counter for 32-bit numbers

/// For each window of time, the frame with the shortest delay if frames are `step` ns apart. A new
/// count of the device (life) begins a new window.
std::vector<CountedFrame> earliest_of_windows(const std::vector<CountedFrame>& frames,
                                              Duration window, double step) {
  std::vector<CountedFrame> out;
  // The arrival of the first frame in the current window.
  HostTime begin;
  // The delay of a frame minus the delay of the window's best frame so far, ns.
  const auto way = [&](const CountedFrame& frame) {
    return static_cast<double>((frame.arrival - begin).count()) -
           step * static_cast<double>(frame.number - out.back().number);
  };
  for (const CountedFrame& frame : frames) {
    if (out.empty() || frame.life != out.back().life || frame.arrival - begin >= window) {
      begin = frame.arrival;
      out.push_back(frame);
    } else if (way(frame) < way(out.back())) {
      out.back() = frame;
    }
  }
  return out;
}

/// The time from each frame to the next frame of the same count, ns per number: quartiles. They are
/// 0 if no two frames follow each other.
struct Steps {
  double low = 0.0, middle = 0.0, high = 0.0;
  bool agree() const { return high - low <= 2.0 * believed * middle; }
};

Steps steps_of(const std::vector<CountedFrame>& frames) {
  std::vector<double> steps;
  steps.reserve(frames.size());
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const CountedFrame &a = frames[i - 1], &b = frames[i];
    // A frame with a lower number arrived late. Its time difference would be negative.
    if (a.life != b.life || b.number <= a.number) continue;
    steps.push_back(static_cast<double>((b.arrival - a.arrival).count()) /
                    static_cast<double>(b.number - a.number));
  }
  if (steps.empty()) return {};
  std::sort(steps.begin(), steps.end());
  const auto at = [&](std::size_t quarter) {
    return std::clamp(steps[quarter * (steps.size() - 1) / 4], 0.0, slowest_step_ns);
  };
  return {at(1), at(2), at(3)};
}

/// The median time per number over all windows. A pause in which the device does not count affects
/// only one or two windows. If many windows have pauses, the median of neighbouring frames is used.
double measured_step_ns(const std::vector<CountedFrame>& frames) {
  if (frames.empty()) return 0.0;
  const Duration length = frames.back().arrival - frames.front().arrival;
  const Duration window = std::clamp(length / windows, shortest_window, longest_window);
  Steps steps;  // 0 at first, so the first round uses the first frame of each window
  // Each round knows the time per number better, so it finds better frames in the windows.
  for (int round = 0; round < 3; ++round) {
    steps = steps_of(earliest_of_windows(frames, window, steps.middle));
  }
  // If the windows disagree, they contain pauses in which the device does not count.
  return steps.agree() ? steps.middle : steps_of(frames).middle;
}

std::string rate_text(double step_ns) { return fmt::format("{:.6g} Hz", 1e9 / step_ns); }

}  // namespace

NodeTime counter_of(const CountedFrame& frame, double step_ns) {
  return NodeTime{Duration{std::llround(step_ns * static_cast<double>(frame.number))}};
}

void count_clock(std::vector<CountedFrame> frames, double stated_step_ns,
                 const DeviceRequest& request, LearnedDevice& learned) {
  if (request.options.rate_hz > 0.0) stated_step_ns = 1e9 / request.options.rate_hz;
  const double measured = measured_step_ns(frames);
  // The stated rate is preferred. Only many frames at another rate contradict it.
  learned.step_ns = stated_step_ns > 0.0 ? stated_step_ns : measured;
  const bool many = static_cast<std::int64_t>(frames.size()) > enough_frames;
  if (stated_step_ns > 0.0 && many && std::abs(measured / stated_step_ns - 1.0) > believed) {
    learned.step_ns = measured;
    learned.findings.push_back(
        {Severity::warning,
         Error{request.file.path, 0, rate_text(stated_step_ns) + ", as stated",
               "frames that arrive at " + rate_text(measured)},
         "stamps were counted by the rate at which they arrive", "set rate_hz to the true rate"});
  }
  // A frame gives an exchange without an echo. Its arrival is late by an unknown delay, so the
  // clock model uses the earliest arrivals.
  std::vector<Exchange> exchanges;
  exchanges.reserve(frames.size());
  for (const CountedFrame& frame : frames) {
    exchanges.push_back({frame.life, counter_of(frame, learned.step_ns), frame.arrival, {}});
  }
  frames = {};  // frees memory: the frames of an hour at 125 Hz take 11 MB
  learned.clock = device_clock(exchanges, learned.utc_minus_host);
}

}  // namespace kinalign
