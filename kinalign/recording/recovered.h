// SPDX-License-Identifier: Apache-2.0
// The counts that `recover` prints.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/recording/survey.h"

#include <cstdint>

namespace kinalign {

struct Recovered {
  std::uint64_t messages = 0;
  /// Messages without a checksum: from a truncated end, from chunks without one, or outside of
  /// chunks.
  std::uint64_t unchecked = 0;
  /// Further copies of messages in several files; the best copy was taken.
  std::uint64_t twice = 0;
  std::uint64_t nameless = 0;  // left out, because the definition of their channel is lost
  std::uint64_t skipped = 0;   // bytes of the old files that could not be read
  /// Messages known to be missing, by their numbers or, for a single file, by its own count.
  std::uint64_t missing = 0;
  RecordingSurvey proof;  // survey of the new file
  Findings findings;      // on the old files, and on the order of the new file
};

}  // namespace kinalign
