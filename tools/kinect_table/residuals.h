// SPDX-License-Identifier: Apache-2.0
// The differences that remain between Kinect and truth inside a take: their size, smoothness and
// whiteness.
#pragma once

#include "tools/kinect_table/figures.h"

namespace kinalign {

/// Standard deviations, autocorrelations and shares above 10 cm, in the body's heading space.
void put_residuals(const std::vector<Repetition>& pieces, Figures& figures);

/// The white part of the differences by the joint's true speed.
void put_white(const std::vector<Repetition>& pieces, Figures& figures);

}  // namespace kinalign
