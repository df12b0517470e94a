// SPDX-License-Identifier: Apache-2.0
// Parts that models of poses and of fusion share: a network that answers on a body.
#pragma once

#include "kinalign/infer/network.h"
#include "kinalign/models/model_file.h"
#include "kinalign/models/pose/pose_body.h"

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct BodyModel {
  ModelFacts facts;
  PoseBody body;          // the mean body of the training people
  bool smoothing = true;  // of whole sequences: weights 1, 4, 6, 4, 1 over five frames
  std::vector<float> input_mean, input_scale;  // [C]
  Architecture architecture;
  std::map<std::string, Tensor> tensors;  // "net." before the names
};

/// The bytes of a file. `own`: the members before "output" in the header.
std::string write_body_model(const BodyModel& model, ModelHeader own);

/// Fills `out`. `read_own` reads the members of the task once those of every model and the body
/// are there; it may throw the JSON library's exceptions. `channels` is asked behind it. Fails
/// where the parts do not fit together.
Result<void> read_body_model(std::string_view bytes, const std::string& name, BodyModel& out,
                             const std::function<Result<void>(const ModelHeader&)>& read_own,
                             const std::function<Result<std::size_t>()>& channels);

/// The network. Fails where it has other channels or answers.
Result<Network> network_of_body(const BodyModel& model, std::size_t channels, std::size_t answers);

}  // namespace kinalign
