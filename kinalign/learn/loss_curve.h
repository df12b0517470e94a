// SPDX-License-Identifier: Apache-2.0
// How a training went, as a picture (SVG 1.1).
#pragma once

#include "kinalign/learn/trainer.h"

#include <string>
#include <vector>

namespace kinalign {

/// The loss over the steps, on a logarithmic axis, and the judgements, each where there is one, on
/// an axis of their own from their least to their greatest value. Nothing but the axes without
/// points.
std::string loss_curve(const std::vector<TrainingPoint>& points, const std::string& title);

}  // namespace kinalign
