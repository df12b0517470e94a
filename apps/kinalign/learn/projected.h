// SPDX-License-Identifier: Apache-2.0
// Answers of a model, projected onto constraints (kinalign/learn/projection.h) by kinalign-learn.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/models/denoise_model.h"

#include <string>
#include <vector>

namespace kinalign {

/// The distance of motions from their constraints, mean of all bodies: the moves of standing feet
/// from frame to frame, and the deviations of bones from their usual length.
/// Both values are measured without the truth, so they can be printed for any motion.
struct ConstraintGaps {
  double feet_cm = 0.0, bone_cm = 0.0;
};

struct ProjectedAnswers {
  Answer answer;  // known only for those bodies and their mirror images
  ConstraintGaps before, after;
};

/// The answers of a model, whose file is `path`, to these bodies. One run of kinalign-learn
/// computes all of them, since it takes a second to start. Fails if it is not installed, or if the
/// model's network has no hidden space.
Result<ProjectedAnswers> projected_answers(const std::string& path, const DenoiseLayout& layout,
                                           const std::vector<JointFrames>& bodies, Call& call);

}  // namespace kinalign
