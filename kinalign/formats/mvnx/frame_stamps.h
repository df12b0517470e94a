// SPDX-License-Identifier: Apache-2.0
// Stamps for the frames of an MVNX file. They are computed from the frame's index and the rate,
// starting at the first frame's time of day. The times in the file are rounded to milliseconds, so
// they are only compared. The index counts all frames of the recording, so a lost frame leaves a
// gap of the right length.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/mvnx/document.h"
#include "kinalign/formats/row_stamps.h"
#include "kinalign/take/manifest.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

class MvnxStamps {
 public:
  explicit MvnxStamps(const StreamOptions& options) : options_(options) {}

  /// The stamp of the next frame. If the frame's index does not rise, the frame is counted and the
  /// result is empty. Fails if there is no rate, or if the stamp is outside +-4e18 ns.
  Result<std::optional<Time>> next(const MvnxHead& head, const MvnxFrame& frame);
  void report(const std::string& file, Findings& findings) const;

 private:
  /// Reads rate, index and start from the first frame.
  Result<void> begin(const MvnxHead& head, const MvnxFrame& frame);

  StreamOptions options_;
  double rate_hz_ = 0.0;
  std::optional<double> first_index_;
  double first_ms_ = 0.0, last_index_ = -1.0;
  std::int64_t start_ns_ = 0;
  // Counts for the findings at the end of the file.
  std::uint64_t not_rising_ = 0, missing_ = 0;
  /// The largest difference between the file's milliseconds and the stamps, s.
  double largest_off_s_ = 0.0;
};

}  // namespace kinalign
