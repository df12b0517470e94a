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

/// The joints of a whole stream in memory. Stamps are in the time of the take.
struct NamedPoints {
  std::string stream;
  std::vector<std::string> joints;
  PointFrames frames;                   // frames whose stamps rise
  std::size_t left_out = 0;             // frames whose stamps repeat or step back
  std::vector<std::string> warnings{};  // from the file's reader
};

/// Reads the joints of a take. The joints of a skeleton become tracked points. Frames whose stamps
/// repeat or step back are left out. Only a child process may read a take (guarded.h).
Result<NamedPoints> points_of_take(FileSystem& files, const std::string& path,
                                   const WantedStream& stream);
/// Reads the joints of any file.
Result<NamedPoints> points_of(const std::string& path, const WantedStream& stream, Call& call);

/// The fraction of elements with a state: 0 missing, 1 inferred, 2 tracked. Returns 0 if there are
/// no elements.
double share_of(const std::vector<std::uint8_t>& seen, std::uint8_t state);

/// The warnings about a Kinect's input: those of the file's reader, and those about `frames`, the
/// same joints at the model's frame rate.
std::vector<std::string> warnings_of(const NamedPoints& points, const EvenFrames& frames);

}  // namespace kinalign
