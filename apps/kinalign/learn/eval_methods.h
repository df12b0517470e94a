// SPDX-License-Identifier: Apache-2.0
// The methods that clean a Kinect: filters, those fitted in closed form, and trained networks.
#pragma once

#include "apps/cli/verb.h"
#include "apps/kinalign/learn/training_job.h"

#include "kinalign/compare/denoise_marks.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/pairs.h"

#include <array>
#include <string>
#include <vector>

namespace kinalign {

struct EvalMethod {
  std::string name, summary;
};
/// The order is that of tables and help pages. The list is made once and lives as long as the
/// program.
const std::vector<EvalMethod>& eval_methods();

/// True for methods that kinalign-learn trains.
bool is_trained(const std::string& method);
/// The name of the method that is trained: "cnn" for "cnn+project", else the method itself.
std::string trained_part(const std::string& method);

/// The input and output joints of methods on these pairs. Fails like denoise_layout().
Result<DenoiseLayout> eval_layout(const Pairs& pairs);

/// The data and the training that a method is made from.
struct EvalTask {
  const DenoiseLayout& layout;
  const std::vector<Pair>& pairs;
  TrainingWanted training;  // every method learns from its takes, trained or not
};

/// Fits or trains the method of `task.training`. `task.layout` and `task.pairs` must live longer.
/// A method in closed form is fitted in this call. A network is trained, unless its model file
/// exists, which may take hours.
Result<Answer> make_answer(const EvalTask& task, Call& call);

/// The answer of a method whose trained part is the model in `file`. `bodies`: the inputs that it
/// will be asked for; projection computes all of them ahead.
Result<Answer> trained_answer(const std::string& method, const std::string& file,
                              const DenoiseLayout& layout, const std::vector<JointFrames>& bodies,
                              Call& call);

/// The marks of the plain answer to a pair, and of the steadied one. `answer`: asked again for the
/// mirror image.
std::array<DenoiseMarks, 2> both_marks(const DenoiseMarker& marker, const Steadier& steadier,
                                       const Answer& answer, const Pair& pair, Denoised plain);

/// The answer of a model's file, without the steadying.
Result<Answer> answer_of_model(const std::string& bytes, const std::string& name);

}  // namespace kinalign
