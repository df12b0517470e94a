// SPDX-License-Identifier: Apache-2.0
// Answers of a model that kinalign-learn has projected onto constraints
// (kinalign/learn/projection.h).
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/models/denoise_model.h"

#include <string>
#include <vector>

namespace kinalign {

/// The errors of constraints, as means over all bodies: how far standing feet move from frame to
/// frame, and how much bones differ from their usual length. No truth is needed to measure them.
struct ConstraintGaps {
  double feet_cm = 0.0, bone_cm = 0.0;
};

struct ProjectedAnswers {
  Answer answer;  // may be called only for the given bodies and their mirror images
  ConstraintGaps before, after;
};

/// The answers of the model in the file `path` to these bodies. One run of kinalign-learn computes
/// all of them, because starting it takes a second. Fails if kinalign-learn is not installed, or if
/// the model's network has no hidden space.
Result<ProjectedAnswers> projected_answers(const std::string& path, const DenoiseLayout& layout,
                                           const std::vector<JointFrames>& bodies, Call& call);

}  // namespace kinalign
