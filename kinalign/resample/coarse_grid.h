// SPDX-License-Identifier: Apache-2.0
// How much of a stream's content a grid that is coarser than its samples can't carry: every raw
// sample is held against what the grid's rows say of its time.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/interpolation/spline.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// Sums over one joint's or node's vectors.
struct CarriedContent {
  std::uint64_t samples = 0;
  std::array<double, 3> sum{};  // of the raw samples
  double squares = 0.0;         // of the raw samples
  double lost = 0.0;            // of the differences

  /// Root mean squares: of the raw samples about their mean, and of what the rows lack.
  double variation() const;
  double missing() const;
};

/// Adds channels first, first + 1, first + 2 of the raw samples between the second row and the last
/// but one: between rows stands the cubic through the four around, as nearly any user of the take
/// would read it. A sine of a tenth of the grid's rate loses 0.3 % of its rms, of a quarter 8 %, of
/// a third 22 %, of half all of it.
void add_content(const Knots& raw, const Knots& rows, std::size_t first, CarriedContent& content);

/// What the figures are of, for the message.
struct ContentNames {
  std::string stream, quantity;    // "imu", "acceleration"
  std::vector<std::string> parts;  // [contents] joints or nodes
  double grid_hz;
  double noise;  // rms that any sensor has, in the quantity's unit: no loss
};

/// One warning where more than a tenth of a part's variation is lost, for the worst part.
Findings judge_carried(const std::vector<CarriedContent>& contents, const ContentNames& names);

}  // namespace kinalign
