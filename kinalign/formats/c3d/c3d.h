// SPDX-License-Identifier: Apache-2.0
// Reads and writes C3D, the format of optical systems. Layout: docs/formats/c3d.md.
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

/// Reads the points of files of all three processors, as integers or floats. A point that the file
/// marks invalid is missing. Stamps come from the file's rate. Analog channels are named in a note
/// and not read. Memory holds the header, the parameters and one frame, each only as far as it was
/// fed: at most 34 MB.
/// The options up, metres_per_unit, rate_hz and start_ns of a manifest override the file.
std::unique_ptr<PointReader> make_c3d_reader(const StreamOptions& options, std::string_view file);

/// True if `head` begins as a C3D does. `head` must reach to the first bytes of the parameters,
/// which most files have at byte 512.
/// Bytes 1 (0x50) and the processor's number are the only marks that a C3D has.
bool looks_like_c3d(std::string_view head);

/// Facts about the points that the file's head states, before the first frame.
struct C3dPoints {
  std::vector<std::string> names;  // [J] at most 65,535, of at most 120 bytes each
  double rate_hz = 0.0;
  std::uint64_t frames = 0;  // at most 2^31 - 1
};

/// Writes frame after frame, in Intel byte order, as floats, in millimetres, z up.
/// The file's head states the number of frames, and a sink can't go back, so the number must be
/// known before the first frame.
class C3dWriter {
 public:
  /// Fails if a C3D can't hold the points; see C3dPoints for the limits.
  static Result<C3dWriter> begin(const C3dPoints& points, FileSink sink);

  /// Appends the next frames. Fails if a stamp lies half a step or more from the even grid that
  /// begins at the first stamp.
  Result<void> append(const PointFrames& frames);
  /// Fills up the last block. Fails if the number of frames differs from the promised one.
  Result<void> finish();

 private:
  C3dWriter(const C3dPoints& points, FileSink sink);

  // After begin() bytes_ holds the head. The sink gets it with the first frames.
  FileSink sink_;
  std::size_t points_;
  double rate_hz_;
  std::uint64_t frames_, written_ = 0;
  Time first_{};
  std::string bytes_;  // bytes that the sink has not received yet
};

}  // namespace kinalign
