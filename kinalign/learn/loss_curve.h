// SPDX-License-Identifier: Apache-2.0
// The course of a training as a picture (SVG 1.1).
#pragma once

#include "kinalign/learn/trainer.h"

#include <string>
#include <vector>

namespace kinalign {

/// Plots the loss over the steps on a logarithmic axis, and the judgements on an axis of their own
/// from their least to their greatest value. Without points only the axes are drawn.
/// A loss falls by powers of ten, so a linear axis would show only its beginning. The file needs no
/// script and no font of its own.
std::string loss_curve(const std::vector<TrainingPoint>& points, const std::string& title);

}  // namespace kinalign
