// SPDX-License-Identifier: Apache-2.0
// TRC, tab-separated optical markers, read and written. Layout: docs/formats/points.md.
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

/// Units mm, cm or m as the file says; y up unless `up` says z; seconds of the Time column, moved
/// so that the first frame has start_ns where that is given. A marker whose cells are empty or
/// "nan" is missing. A wrong NumFrames is a finding; a blank line behind the rows ends them.
std::unique_ptr<PointReader> make_trc_reader(const StreamOptions& options, std::string_view file);

bool looks_like_trc(std::string_view head);

/// What stands above the rows.
struct TrcHead {
  std::vector<std::string> names;  // [J] without tabs and line ends
  double rate_hz = 0.0;
  std::uint64_t frames = 0;
  std::string file;  // the name that the file states of itself
  Time zero{};       // the stamp of Time 0
};

/// Writes frame after frame: millimetres to 0.00001, y up, seconds to the nanosecond, empty cells
/// for a missing marker. The caller commits `out`, which must outlive the writer.
class TrcWriter {
 public:
  static Result<TrcWriter> begin(const TrcHead& head, TextOut& out);
  Result<void> append(const PointFrames& frames);
  /// Fails where other than the promised frames were given.
  Result<void> finish() const;

 private:
  TrcWriter(const TrcHead& head, TextOut& out);

  TextOut* out_;
  std::size_t markers_;
  std::uint64_t frames_, written_ = 0;
  Time zero_;
};

}  // namespace kinalign
