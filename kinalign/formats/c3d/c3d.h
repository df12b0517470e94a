// SPDX-License-Identifier: Apache-2.0
// C3D, points of optical systems, read and written. Layout: docs/formats/c3d.md.
#pragma once

#include "kinalign/formats/file_sink.h"
#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Points of all three processors, integers or floats; a point that the file marks invalid is
/// missing. Stamps are counted by the file's rate. Analog channels are named in a note and not
/// read. Memory goes by the header, the parameters and one frame, each as far as it was fed: at
/// most 34 MB.
std::unique_ptr<PointReader> make_c3d_reader(const StreamOptions& options, std::string_view file);

/// `head` must reach to the parameters' first bytes, which most files have at byte 512.
bool looks_like_c3d(std::string_view head);

/// What must be known of points before the first frame is written.
struct C3dPoints {
  std::vector<std::string> names;  // [J] at most 65,535, of at most 120 bytes each
  double rate_hz = 0.0;
  std::uint64_t frames = 0;  // at most 2^31 - 1
};

/// Writes frame after frame: Intel, floats, millimetres, z up.
class C3dWriter {
 public:
  /// Fails where a C3D can't hold the points: see C3dPoints.
  static Result<C3dWriter> begin(const C3dPoints& points, FileSink sink);

  /// The next frames. Fails where a stamp lies half a step or more from the even grid that begins
  /// at the first stamp.
  Result<void> append(const PointFrames& frames);
  /// Fills the last block. Fails where other than the promised frames were given.
  Result<void> finish();

 private:
  C3dWriter(const C3dPoints& points, FileSink sink);

  FileSink sink_;
  std::size_t points_;
  double rate_hz_;
  std::uint64_t frames_, written_ = 0;
  Time first_{};
  std::string bytes_;  // not yet handed on
};

}  // namespace kinalign
