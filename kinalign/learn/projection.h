// SPDX-License-Identifier: Apache-2.0
// Constraint projection: Holden, Saito, Komura, SIGGRAPH 2016, section 6. Gradient steps in the
// hidden space of a convolutional autoencoder, until the motion that it decodes to meets
// constraints: feet that stand do not slide, bones keep their lengths, the root keeps its path. All
// three come from the input and the model's answer to it, so that no truth is needed.
#pragma once

#include "kinalign/models/denoise_model.h"

#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

struct ProjectionOptions {
  std::int64_t steps = 50;  // of Adam
  double rate = 0.01;
  // Weights of mean squares, in cm^2: moves of standing feet from frame to frame, moves of roots
  // away from the answer, bones that are longer or shorter than their usual length.
  double feet = 10.0, path = 10.0, bones = 1.0;
};

/// How far a motion is from its constraints: roots of the mean squares.
struct ConstraintErrors {
  double feet_cm = 0.0;  // from frame to frame; 0 where no foot ever stands
  double path_cm = 0.0, bone_cm = 0.0;
};

struct Projected {
  Denoised answer;                 // in the body's space, without the steadying
  ConstraintErrors before, after;  // of the answer as it was, and as it is
};

/// Whether the model's network has a hidden space: an unpool in its list of layers, alone, and no
/// network behind it.
bool has_hidden_space(const DenoiseModel& model);

/// `body`: frames of the layout's inputs at its rate. Fails where the network has no hidden space.
Result<Projected> project(const DenoiseModel& model, const JointFrames& body,
                          const ProjectionOptions& options = {});

/// Frames [T] in which a foot [T,3] m stands: slow, near the lowest place where it comes, for four
/// frames or more.
std::vector<std::uint8_t> standing_frames(std::span<const float> foot, double rate_hz);

}  // namespace kinalign
