// SPDX-License-Identifier: Apache-2.0
// The methods that clean a Kinect: filters, those fitted in closed form, and trained networks.
#pragma once

#include "apps/cli/verb.h"
#include "apps/kinalign/learn/training_job.h"

#include "kinalign/models/denoise_model.h"
#include "kinalign/models/pairs.h"

#include <string>
#include <vector>

namespace kinalign {

struct EvalMethod {
  std::string name, summary;
  bool trained = false;  // by kinalign-learn
};
const std::vector<EvalMethod>& eval_methods();

/// Whether it is trained by kinalign-learn.
bool is_trained(const std::string& method);
/// The method that is trained for it: "cnn" of "cnn+project", else itself.
std::string trained_part(const std::string& method);

/// What methods see and answer on these pairs. Fails as denoise_layout().
Result<DenoiseLayout> eval_layout(const Pairs& pairs);

/// All that a method is made from.
struct EvalTask {
  const DenoiseLayout& layout;
  const std::vector<Pair>& pairs;
  TrainingWanted training;  // its takes are learnt from by every method, trained or not
};

/// Fits or trains the method of `task.training`. `task.layout` and `task.pairs` must live longer.
Result<Answer> make_answer(const EvalTask& task, Call& call);

/// The answer of a method whose trained part is the model in `file`. `bodies`: those that it will
/// be asked for, which matter where it is brought to meet constraints.
Result<Answer> trained_answer(const std::string& method, const std::string& file,
                              const DenoiseLayout& layout, const std::vector<JointFrames>& bodies,
                              Call& call);

/// The answer of a model's file, without the steadying.
Result<Answer> answer_of_model(const std::string& bytes, const std::string& name);

}  // namespace kinalign
