// SPDX-License-Identifier: Apache-2.0
// Reads and writes C3D, the file format of optical motion capture systems. Layout:
// docs/formats/c3d.md.
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

/// Makes a reader of the points in a C3D file, for all three processors and for integers and
/// floats. A point that the file marks as invalid is missing. Stamps come from the file's rate.
/// Analog channels are not read; a note names them. The manifest's options up, metres_per_unit,
/// rate_hz and start_ns override the file. The reader keeps only the header, the parameters and one
/// frame in memory, at most 34 MB.
std::unique_ptr<PointReader> make_c3d_reader(const StreamOptions& options, std::string_view file);

/// True if `head` begins like a C3D file. `head` must include the first bytes of the parameters,
/// which most files have at byte 512. The only marks of a C3D file are byte 1 (0x50) and the number
/// of the processor.
bool looks_like_c3d(std::string_view head);

/// Facts about the points in a file's head. They must be known before the first frame.
struct C3dPoints {
  std::vector<std::string> names;  // [J] at most 65,535 names of at most 120 bytes
  double rate_hz = 0.0;
  std::uint64_t frames = 0;  // at most 2^31 - 1
};

/// Writes frames as floats in Intel byte order, in millimetres, z up. The head of the file contains
/// the number of frames, so this number must be known before the first frame.
class C3dWriter {
 public:
  /// Fails if the points exceed the limits in C3dPoints.
  static Result<C3dWriter> begin(const C3dPoints& points, FileSink sink);

  /// Appends the next frames. The stamps must be evenly spaced: fails if a stamp differs by half a
  /// frame time or more from its place.
  Result<void> append(const PointFrames& frames);
  /// Completes the last block. Fails if the number of frames differs from that in the head.
  Result<void> finish();

 private:
  C3dWriter(const C3dPoints& points, FileSink sink);

  // After begin(), bytes_ contains the head. The sink receives it with the first frames.
  FileSink sink_;
  std::size_t points_;
  double rate_hz_;
  std::uint64_t frames_, written_ = 0;
  Time first_{};
  std::string bytes_;  // bytes that were not passed to the sink yet
};

}  // namespace kinalign
