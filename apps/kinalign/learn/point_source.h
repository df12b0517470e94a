// SPDX-License-Identifier: Apache-2.0
// The joints of one stream, out of a take, a recording, a manifest or a device's file.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/models/even_grid.h"
#include "kinalign/motion/streams.h"

#include <string>
#include <vector>

namespace kinalign {

struct NamedPoints {
  std::string stream;
  std::vector<std::string> joints;
  PointFrames frames;                   // stamps rise
  std::size_t left_out = 0;             // frames whose stamps repeat or step back
  std::vector<std::string> warnings{};  // of the file's reader
};

/// `stream`: its name; empty: the only stream of points. A skeleton's joints are taken as tracked
/// points. Stamps that repeat or step back are left out. Takes: only in a child process
/// (guarded.h).
Result<NamedPoints> points_of_take(FileSystem& files, const std::string& path,
                                   const std::string& stream);
Result<NamedPoints> points_of_file(const std::string& path, const std::string& stream, Call& call);

/// Warnings of a Kinect's frames, before a model sees them. `left_out`: NamedPoints'.
std::vector<std::string> warnings_of(const EvenFrames& frames, std::size_t left_out);

}  // namespace kinalign
