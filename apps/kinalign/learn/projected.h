// SPDX-License-Identifier: Apache-2.0
// Answers of a model that are brought to meet constraints (kinalign/learn/projection.h), by
// kinalign-learn.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/models/denoise_model.h"

#include <string>
#include <vector>

namespace kinalign {

/// How far motions are from their constraints, mean of all bodies: moves of standing feet from
/// frame to frame, and bones that are longer or shorter than usual.
struct ConstraintGaps {
  double feet_cm = 0.0, bone_cm = 0.0;
};

struct ProjectedAnswers {
  Answer answer;  // to those bodies and their mirror images alone
  ConstraintGaps before, after;
};

/// The answers of a model, whose file is `path`, to these bodies. All are computed in one run of
/// the program, which takes a second to start. Fails where it is not installed, and where the
/// model's network has no hidden space.
Result<ProjectedAnswers> projected_answers(const std::string& path, const DenoiseLayout& layout,
                                           const std::vector<JointFrames>& bodies, Call& call);

}  // namespace kinalign
