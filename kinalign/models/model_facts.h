// SPDX-License-Identifier: Apache-2.0
// Facts that a model's file states in addition to the weights.
#pragma once

#include <string>

namespace kinalign {

/// `task` decides which reader a file needs. `training` and `metrics` stay JSON text, so this
/// header does not need the JSON library.
struct ModelFacts {
  std::string task, method, software;
  std::string training;  // JSON: data, licences, hashes, settings
  std::string metrics;   // JSON
};

}  // namespace kinalign
