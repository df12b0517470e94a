// SPDX-License-Identifier: Apache-2.0
// The methods that eval compares: filters, those fitted in closed form, and trained networks.
#pragma once

#include "apps/cli/verb.h"

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

/// All that a method is made from.
struct EvalTask {
  const DenoiseLayout& layout;
  const std::vector<Pair>& pairs;
  std::vector<std::string> learnt;  // names of takes
  std::string windows, input, truth;
  std::string folder;  // of the run: its job, its log and its model, which is used if it is there
  std::string device;  // cpu, cuda
  std::int64_t seed = 1, steps = 0;
};

/// Fits or trains it.
Result<Answer> make_answer(const std::string& method, const EvalTask& task, Call& call);

}  // namespace kinalign
