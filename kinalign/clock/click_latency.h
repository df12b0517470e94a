// SPDX-License-Identifier: Apache-2.0
// For motion capture without stamps: the time between a click on «record» and its effect, the
// paper's lambda, and an estimate of the frame step from clicks and numbers of frames.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

/// A click and its effect: the first frame of a live stream, or a shock that both devices record.
struct ClickPair {
  HostTime click{}, response{};
};

struct ClickLatency {
  Duration median{};
  Duration spread{};  // 1.4826 times the median absolute deviation: a standard deviation if normal
  Duration low{}, high{};  // contain the median with at least 95 % probability, for any
                           // distribution of the latency
};

/// Fewest pairs for an interval: with five, all lie on one side of the median in 6 % of the cases.
inline constexpr std::size_t least_click_pairs = 6;

/// Absent for fewer than six pairs.
std::optional<ClickLatency> click_latency(std::span<const ClickPair> pairs);

/// A take between two clicks, and its number of frames.
struct ClickedTake {
  HostTime start{}, stop{};  // times of the clicks
  std::uint64_t frames = 0;
};

/// Fit of T_e - T_s = step * frames + (lambda_s - lambda_e), a line through takes of several
/// lengths.
struct ClickedStep {
  double step_s = 0.0, step_deviation_s = 0.0;
  double latency_difference_s = 0.0, latency_deviation_s = 0.0;
};

/// Absent for fewer than three takes, or if all have the same length.
std::optional<ClickedStep> clicked_step(std::span<const ClickedTake> takes);

}  // namespace kinalign
