// SPDX-License-Identifier: Apache-2.0
// Parts shared by models of poses and of fusion: a network that estimates the rotations of a body.
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

/// A network and the body whose rotations it estimates.
struct BodyModel {
  ModelFacts facts;
  PoseBody body;          // the mean body of the training people
  bool smoothing = true;  // smooth whole sequences: weights 1, 4, 6, 4, 1 over five frames
  std::vector<float> input_mean, input_scale;  // one number for each input channel
  Architecture architecture;
  std::map<std::string, Tensor> tensors;  // names begin with "net."
};

/// The bytes of a file. `own`: the header's members of the task, written before "output".
std::string write_body_model(const BodyModel& model, ModelHeader own);

/// Reads a file into `out`. `read_own` reads the header's members of the task; it is called once
/// the facts are known and may throw the JSON library's exceptions. `channels` gives the number of
/// input channels; it is called after the body is read. Fails if the parts do not fit together.
Result<void> read_body_model(std::string_view bytes, const std::string& name, BodyModel& out,
                             const std::function<Result<void>(const ModelHeader&)>& read_own,
                             const std::function<Result<std::size_t>()>& channels);

/// The model's network. Fails if it does not have `channels` inputs and `answers` outputs.
Result<Network> network_of_body(const BodyModel& model, std::size_t channels, std::size_t answers);

}  // namespace kinalign
