// SPDX-License-Identifier: Apache-2.0
// Members of a model's header that say on what body it answers, the same for poses and fusion.
#pragma once

#include "kinalign/models/model_file.h"
#include "kinalign/models/pose/pose_body.h"

#include <vector>

namespace kinalign {

/// What stands behind "output" in the header.
ModelHeader body_header(const PoseBody& body, bool smoothing);

struct BodyOfHeader {
  PoseBody body;
  bool smoothing = true;
};
/// Throws the JSON library's exception where a member is missing or of another type.
BodyOfHeader body_of_header(const ModelHeader& output);

/// Fails where the body has no bones of finite length, more than 1000 joints, or parts that do not
/// fit together.
Result<void> check_body(const PoseBody& body);

/// Fails where mean and scale have not `channels` numbers or a scale is not above 0.
Result<void> check_scales(std::size_t channels, const std::vector<float>& mean,
                          const std::vector<float>& scale);

}  // namespace kinalign
