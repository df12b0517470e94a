// SPDX-License-Identifier: Apache-2.0
// Motion capture without stamps: what lies between a click on «record» and its effect, the paper's
// lambda, and what clicks and counts of frames say of the frame step.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

/// A click and the response to it: the first frame of a live stream, or a shock that both show.
struct ClickPair {
  HostTime click{}, response{};
};

struct ClickLatency {
  Duration median{};
  Duration spread{};  // 1.4826 times the median absolute deviation: a standard deviation if normal
  Duration low{}, high{};  // hold the median with 95 % at least, whatever the law of the latency
};

/// Least pairs for an interval: of five, all lie on one side in 6 % of the cases.
inline constexpr std::size_t least_click_pairs = 6;

/// Absent with fewer than six pairs.
std::optional<ClickLatency> click_latency(std::span<const ClickPair> pairs);

/// A take between two clicks.
struct ClickedTake {
  HostTime start{}, stop{};  // of the clicks
  std::uint64_t frames = 0;
};

/// T_e - T_s = step * frames + (lambda_s - lambda_e), as a line through takes of several lengths.
struct ClickedStep {
  double step_s = 0.0, step_deviation_s = 0.0;
  double latency_difference_s = 0.0, latency_deviation_s = 0.0;
};

/// Absent with fewer than three takes, or takes of one length.
std::optional<ClickedStep> clicked_step(std::span<const ClickedTake> takes);

}  // namespace kinalign
