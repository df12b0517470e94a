// SPDX-License-Identifier: Apache-2.0
// The methods that are trained, a file each in methods/.
#pragma once

#include "kinalign/learn/denoise_task.h"
#include "kinalign/learn/trainer.h"

#include <string_view>
#include <vector>

namespace kinalign {

/// A network that cleans skeletons.
struct DenoiseMethod {
  std::string_view name, summary, source;
  /// From the layout's channels to its answers (and, if it states a spread, one more a joint).
  Architecture (*architecture)(const DenoiseLayout& layout);
  DenoiseTraining training;
  TrainingOptions options;
  bool from_base = true;   // answers what the smoothed input joint is off by; else where a joint is
  bool zero_last = false;  // begins as its base
  bool perceptual = false;  // BRA-P: trains a network of clean motion first
};

DenoiseMethod refine_method();
DenoiseMethod cnn_method();
DenoiseMethod bra_method();
DenoiseMethod bra_p_method();

std::vector<DenoiseMethod> denoise_methods();

}  // namespace kinalign
