// SPDX-License-Identifier: Apache-2.0
// Pairs of a rough and a precise stream out of a file of windows.
#pragma once

#include "kinalign/learn/denoise_task.h"
#include "kinalign/learn/windows_file.h"

#include <string>
#include <vector>

namespace kinalign {

struct Pairs {
  std::vector<std::string> inputs, outputs;  // joints
  double rate_hz = 0.0;
  std::vector<Pair> learnt{},
      judged{};  // of the parts train and validation; all where there is one
};

/// Fails where the file lacks a stream or its positions. Stretches shorter than `least` rows are
/// left out.
Result<Pairs> pairs_of(const Windows& windows, const std::string& input, const std::string& truth,
                       std::size_t least);

}  // namespace kinalign
