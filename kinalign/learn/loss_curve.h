// SPDX-License-Identifier: Apache-2.0
// The course of a training as a picture (SVG 1.1).
#pragma once

#include "kinalign/learn/trainer.h"

#include <string>
#include <vector>

namespace kinalign {

/// Plots the loss over the steps on a logarithmic axis, because a loss falls by powers of ten. The
/// validation errors have a separate axis, from the smallest to the largest. Without points only
/// the axes are drawn. The picture contains no script and no font.
std::string loss_curve(const std::vector<TrainingPoint>& points, const std::string& title);

}  // namespace kinalign
