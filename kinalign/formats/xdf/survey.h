// SPDX-License-Identifier: Apache-2.0
// An XDF file read through once: what streams it has, and what is wrong with it.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/formats/xdf/clock.h"
#include "kinalign/formats/xdf/xdf.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// By its first bytes.
Result<bool> is_xdf(FileSystem& files, const std::string& path);

/// All items of a file, in its order, and what was wrong with it. Fails where `take` does.
Result<Findings> read_xdf(FileSystem& files, const std::string& path, const Progress& progress,
                          const std::function<Result<void>(const XdfItem&)>& take);

struct XdfStreamSurvey {
  XdfStream stream;
  std::uint64_t samples = 0, deduced = 0;  // stamps that were not written
  std::optional<double> first, last;       // least and greatest stamp, s of the sender's clock
  std::uint64_t backward = 0;              // stamps that step back
  double largest_step_back_s = 0.0;
  std::uint64_t timeless = 0;    // samples whose stamp is no number below 1e15
  std::uint64_t no_numbers = 0;  // values that are NaN or infinite
  std::uint64_t clock_offsets = 0;
  std::vector<XdfClockLine> clock;  // one for each stretch between resets of the sender's clock

  /// By the first and the last stamp, pauses and all; 0 where there is no time between them.
  double rate_hz() const;
};

struct XdfSurvey {
  std::uint64_t bytes = 0;
  std::vector<XdfStreamSurvey> streams;  // in the order of the file
  Findings findings;                     // of the reader
};

Result<XdfSurvey> survey_xdf(FileSystem& files, const std::string& path, const Progress& progress);

}  // namespace kinalign
