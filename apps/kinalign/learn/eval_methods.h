// SPDX-License-Identifier: Apache-2.0
// The methods that clean the joints of a Kinect: filters, methods fitted by a formula, and trained
// networks.
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
/// All methods, in the order of tables and help pages. The list lives as long as the program.
const std::vector<EvalMethod>& eval_methods();

/// True if kinalign-learn trains the method.
bool is_trained(const std::string& method);
/// The method whose training is used: "cnn" for "cnn+project", else the method itself.
std::string trained_part(const std::string& method);

/// The input and output joints of all methods for these pairs. Fails like denoise_layout().
Result<DenoiseLayout> eval_layout(const Pairs& pairs);

/// The data and the settings from which a method is made.
struct EvalTask {
  const DenoiseLayout& layout;
  const std::vector<Pair>& pairs;
  TrainingWanted training;  // all methods learn from its takes, trained or not
};

/// Makes the function that answers for the method `task.training`. Methods with a formula are
/// fitted in this call. A network is trained unless its model's file exists, which may take hours.
/// `task.layout` and `task.pairs` must live longer than the function.
Result<Answer> make_answer(const EvalTask& task, Call& call);

/// The function of a method that uses the trained model in `file`. `bodies`: the inputs for which
/// it will be called, because the projection computes all answers in advance.
Result<Answer> trained_answer(const std::string& method, const std::string& file,
                              const DenoiseLayout& layout, const std::vector<JointFrames>& bodies,
                              Call& call);

/// The marks of the plain answer to a pair, and of the steadied answer. `answer` is called again
/// with the mirrored input.
std::array<DenoiseMarks, 2> both_marks(const DenoiseMarker& marker, const Steadier& steadier,
                                       const Answer& answer, const Pair& pair, Denoised plain);

/// The function of a model's file, which gives plain answers.
Result<Answer> answer_of_model(const std::string& bytes, const std::string& name);

}  // namespace kinalign
