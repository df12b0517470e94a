// SPDX-License-Identifier: Apache-2.0
// A method: a network, what it is trained on, how it is trained.
#pragma once

#include "kinalign/learn/denoise_task.h"
#include "kinalign/learn/trainer.h"

#include <string_view>

namespace kinalign {

/// A network that cleans skeletons.
struct DenoiseMethod {
  std::string_view name, summary, source;
  /// From the layout's channels to its answers (and, if it states a spread, one more a joint).
  Architecture (*architecture)(const DenoiseLayout& layout);
  DenoiseTraining training;
  TrainingOptions options;
  bool from_base = true;  // answers what the smoothed input joint is off by; else where a joint is
  /// Begins as a linear answer: the network is a sum of a slice with a conv, and of a correction
  /// that ends with a linear layer.
  bool begins_linear = false;
  bool perceptual = false;  // BRA-P: trains a network of clean motion first
};

}  // namespace kinalign
