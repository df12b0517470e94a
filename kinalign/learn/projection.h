// SPDX-License-Identifier: Apache-2.0
// Constraint projection (Holden, Saito, Komura, SIGGRAPH 2016, section 6): gradient steps in the
// hidden space of a convolutional autoencoder until the decoded motion meets constraints. Standing
// feet do not slide, bones keep their lengths, the root keeps its path. All constraints come from
// the input and the model's result, so no ground truth is needed.
#pragma once

#include "kinalign/models/denoise_model.h"

#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

struct ProjectionOptions {
  std::int64_t steps = 50;  // number of steps of Adam
  double rate = 0.01;       // learning rate of Adam
  // Weights of mean squares in cm^2: motion of standing feet between frames, distance of roots from
  // the model's result, deviation of bones from their median length.
  double feet = 10.0, path = 10.0, bones = 1.0;
};

/// Deviations of a motion from its constraints: roots of the mean squares.
struct ConstraintErrors {
  double feet_cm = 0.0;  // motion between frames; 0 if no foot ever stands
  double path_cm = 0.0, bone_cm = 0.0;
};

/// The projected joints. The caller post-processes them like those of any method (Steadier).
struct Projected {
  Denoised answer;                 // in the space of the body, not yet post-processed
  ConstraintErrors before, after;  // of the model's result; of the projected one
};

/// True if the model's network has a hidden space: exactly one unpool in its list of layers, and no
/// second network.
bool has_hidden_space(const DenoiseModel& model);

/// `body`: frames of the layout's input joints at its rate. Fails if the network has no hidden
/// space.
Result<Projected> project(const DenoiseModel& model, const JointFrames& body,
                          const ProjectionOptions& options = {});

/// Frames [T] in which a foot [T,3] m stands: it is slow and near its lowest height for at least
/// four frames.
std::vector<std::uint8_t> standing_frames(std::span<const float> foot, double rate_hz);

}  // namespace kinalign
