// SPDX-License-Identifier: Apache-2.0
// Reads and writes TRC, tab-separated optical markers. Layout: docs/formats/points.md.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Reads TRC. The file states its unit, mm, cm or m. y is up unless `up` says z. Stamps are the
/// seconds of the Time column; if start_ns is given, they are shifted so that the first frame gets
/// it. A marker with empty cells or "nan" is missing. A wrong NumFrames is a finding. A blank line
/// after the rows ends them.
/// rate_hz is used if the times never move.
std::unique_ptr<PointReader> make_trc_reader(const StreamOptions& options, std::string_view file);

bool looks_like_trc(std::string_view head);

/// The head of the file, above the rows.
/// The number of frames stands above the rows, so it must be known before.
struct TrcHead {
  std::vector<std::string> names;  // [J] without tabs and line ends
  double rate_hz = 0.0;
  std::uint64_t frames = 0;
  std::string file;  // the name that the file states for itself
  Time zero{};       // the stamp of Time 0
};

/// Writes frame after frame: millimetres to five decimals, y up, times to the nanosecond, empty
/// cells for a missing marker. The caller commits `out`, which must outlive the writer.
/// Order of calls: begin(), append() until all frames are written, finish(), then commit `out`.
class TrcWriter {
 public:
  static Result<TrcWriter> begin(const TrcHead& head, TextOut& out);
  Result<void> append(const PointFrames& frames);
  /// Fails if the number of frames differs from the promised one.
  Result<void> finish() const;

 private:
  TrcWriter(const TrcHead& head, TextOut& out);

  TextOut* out_;
  std::size_t markers_;
  std::uint64_t frames_, written_ = 0;
  Time zero_;
};

}  // namespace kinalign
