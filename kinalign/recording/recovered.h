// SPDX-License-Identifier: Apache-2.0
// The counts that `recover` prints.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/recording/survey.h"

#include <cstdint>

namespace kinalign {

struct Recovered {
  std::uint64_t messages = 0;
  /// Of these no checksum covers: from a torn end, from chunks without one, or outside of chunks.
  std::uint64_t unchecked = 0;
  /// Further copies of messages that stood in several files; the best copy was taken.
  std::uint64_t twice = 0;
  std::uint64_t nameless = 0;  // left out: the definition of their channel is lost
  std::uint64_t skipped = 0;   // bytes of the old files in which nothing could be read
  /// Of which it is known that they were there: by their numbers or, of a single file, by its own
  /// count.
  std::uint64_t missing = 0;
  RecordingSurvey proof;  // of the new file
  Findings findings;      // of the old ones, and of the new one's order
};

}  // namespace kinalign
