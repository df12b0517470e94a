// SPDX-License-Identifier: Apache-2.0
// Reads and writes TRC, a tab-separated text format for optical markers. Layout:
// docs/formats/points.md.
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

/// Reads a TRC file. The file states its unit (mm, cm or m). y is up unless the option `up` is z.
/// Stamps are the seconds in the Time column. If start_ns is given, they are shifted so that the
/// first frame has this stamp. If all times are equal, the stamps come from rate_hz. A marker with
/// empty cells or "nan" is missing. A wrong NumFrames is a finding. A blank line after the rows
/// ends them.
std::unique_ptr<PointReader> make_trc_reader(const StreamOptions& options, std::string_view file);

bool looks_like_trc(std::string_view head);

/// The head of a file. It contains the number of frames, so that number must be known first.
struct TrcHead {
  std::vector<std::string> names;  // [J] without tabs and line ends
  double rate_hz = 0.0;
  std::uint64_t frames = 0;
  std::string file;  // the file's name, which stands in its head
  Time zero{};       // the stamp that becomes time 0
};

/// Writes frames: positions in millimetres to five decimals, y up, times to the nanosecond, and
/// empty cells for missing markers. Call begin(), then append() until all frames are written, then
/// finish(). The caller then commits `out`, which must exist longer than the writer.
class TrcWriter {
 public:
  static Result<TrcWriter> begin(const TrcHead& head, TextOut& out);
  Result<void> append(const PointFrames& frames);
  /// Fails if the number of frames differs from that in the head.
  Result<void> finish() const;

 private:
  TrcWriter(const TrcHead& head, TextOut& out);

  TextOut* out_;
  std::size_t markers_;
  std::uint64_t frames_, written_ = 0;
  Time zero_;
};

}  // namespace kinalign
