// SPDX-License-Identifier: Apache-2.0
// Reads the joints of one stream from a take, a recording, a manifest or a device's file.
#pragma once

#include "apps/kinalign/learn/motion_input.h"

#include "kinalign/models/even_grid.h"
#include "kinalign/motion/streams.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The whole stream in memory: T frames of J joints. Stamps are on the take's clock.
struct NamedPoints {
  std::string stream;
  std::vector<std::string> joints;
  PointFrames frames;                   // stamps rise
  std::size_t left_out = 0;             // frames whose stamps repeat or step back
  std::vector<std::string> warnings{};  // from the file's reader
};

/// A skeleton's joints are read as tracked points. Stamps that repeat or step back are left out.
/// Takes may be read only in a child process (guarded.h).
Result<NamedPoints> points_of_take(FileSystem& files, const std::string& path,
                                   const WantedStream& stream);
/// The same for any file.
Result<NamedPoints> points_of(const std::string& path, const WantedStream& stream, Call& call);

/// The fraction of cells with that state: 0 missing, 1 inferred, 2 tracked. 0 without cells.
double share_of(const std::vector<std::uint8_t>& seen, std::uint8_t state);

/// Warnings about a Kinect before a model gets its frames: the reader's, and those about `frames`,
/// which `points` were brought to.
std::vector<std::string> warnings_of(const NamedPoints& points, const EvenFrames& frames);

}  // namespace kinalign
