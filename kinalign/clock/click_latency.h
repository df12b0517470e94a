// SPDX-License-Identifier: Apache-2.0
// For motion capture without stamps. Computes the time between a click on «record» and its effect
// (lambda in the HFUT-MMD paper). Also estimates the frame period from the clicks and frame counts
// of several takes.
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
  Duration spread{};  // 1.4826 times the median absolute deviation; for a normal distribution, sd
  Duration low{}, high{};  // contain the median with at least 95 % probability, for any
                           // distribution of the latency
};

/// Fewest pairs that give an interval. With five pairs, all lie on one side of the median in 6 % of
/// the cases.
inline constexpr std::size_t least_click_pairs = 6;

/// The result is absent if there are fewer than six pairs.
std::optional<ClickLatency> click_latency(std::span<const ClickPair> pairs);

/// A take that two clicks began and ended, and its number of frames.
struct ClickedTake {
  HostTime start{}, stop{};  // times of the clicks
  std::uint64_t frames = 0;
};

/// Fits T_e - T_s = step * frames + (lambda_s - lambda_e) to takes of different lengths. T_s and
/// T_e are the clicks at start and end, lambda_s and lambda_e their latencies.
struct ClickedStep {
  double step_s = 0.0, step_deviation_s = 0.0;
  double latency_difference_s = 0.0, latency_deviation_s = 0.0;
};

/// The result is absent if there are fewer than three takes or all have the same length.
std::optional<ClickedStep> clicked_step(std::span<const ClickedTake> takes);

}  // namespace kinalign
