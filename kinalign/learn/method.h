// SPDX-License-Identifier: Apache-2.0
// A method: a network, its training data, and its training.
#pragma once

#include "kinalign/learn/denoise_task.h"
#include "kinalign/learn/trainer.h"

#include <cstdint>
#include <string_view>

namespace kinalign {

/// The output of a network before its training.
enum class Begins : std::uint8_t {
  as_drawn,  // random weights
  as_base,   // the base plus the mean offset
  linear,    // DenoiseTask::linear_answer(); the network is a sum of (slice, conv) and a correction
};

/// A network that cleans skeletons.
/// All in which two methods differ. DenoiseTask and train() are the same for all of them.
struct DenoiseMethod {
  std::string_view name, summary, source;
  /// The network from the layout's channels to its answers, plus one channel per joint if it states
  /// a spread.
  Architecture (*architecture)(const DenoiseLayout& layout);
  DenoiseTraining training;
  TrainingOptions options;
  /// The network outputs corrections of the smoothed input joint; false: positions.
  bool from_base = true;
  Begins begins = Begins::as_drawn;
  bool perceptual = false;  // BRA-P: trains a network of clean motion first, for the loss
  bool has_second = false;  // that network also refines the answers at use
};

}  // namespace kinalign
