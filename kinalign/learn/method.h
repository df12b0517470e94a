// SPDX-License-Identifier: Apache-2.0
// A method: a network, what it is trained on, how it is trained.
#pragma once

#include "kinalign/learn/denoise_task.h"
#include "kinalign/learn/trainer.h"

#include <cstdint>
#include <string_view>

namespace kinalign {

/// What a network answers before its training.
enum class Begins : std::uint8_t {
  as_drawn,  // anything
  as_base,   // the base and the mean offset
  linear,    // DenoiseTask::linear_answer(): a sum of a slice with a conv, and of a correction
};

/// A network that cleans skeletons.
struct DenoiseMethod {
  std::string_view name, summary, source;
  /// From the layout's channels to its answers (and, if it states a spread, one more a joint).
  Architecture (*architecture)(const DenoiseLayout& layout);
  DenoiseTraining training;
  TrainingOptions options;
  bool from_base = true;  // answers what the smoothed input joint is off by; else where a joint is
  Begins begins = Begins::as_drawn;
  bool perceptual = false;  // BRA-P: trains a network of clean motion first
  bool has_second = false;  // and that network stands behind it
};

}  // namespace kinalign
