// SPDX-License-Identifier: Apache-2.0
// A method: a network, its training data, and its training.
#pragma once

#include "kinalign/learn/denoise_task.h"
#include "kinalign/learn/trainer.h"

#include <cstdint>
#include <string_view>

namespace kinalign {

/// The weights of a network before its training.
enum class Begins : std::uint8_t {
  as_drawn,  // random weights
  as_base,   // weights with which the network outputs the base plus the mean offset
  linear,    // DenoiseTask::linear_answer(); the network is a sum of (slice, conv) and a correction
};

/// A method that cleans skeletons. Methods differ only in these members; DenoiseTask and train()
/// are the same for all.
struct DenoiseMethod {
  std::string_view name, summary, source;
  /// The network from the layout's channels to its outputs: three for each joint, plus one for each
  /// joint if the network outputs a spread.
  Architecture (*architecture)(const DenoiseLayout& layout);
  DenoiseTraining training;
  TrainingOptions options;
  /// True: the network outputs corrections of the smoothed input joints. False: it outputs
  /// positions.
  bool from_base = true;
  Begins begins = Begins::as_drawn;
  bool perceptual = false;  // BRA-P: trains a network of clean motion first, for the loss
  bool has_second = false;  // the network of clean motion also refines the joints in use
};

}  // namespace kinalign
