// SPDX-License-Identifier: Apache-2.0
// Reads pairs of a rough stream (the input) and a precise stream (the ground truth) from a file of
// windows.
#pragma once

#include "kinalign/models/joint_frames.h"
#include "kinalign/models/windows_file.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The data of both devices for one motion, between two gaps of a take. The truth is in the space
/// of the input.
/// All arrays have the same T rows, at the rate of the file.
struct Pair {
  JointFrames input;
  std::vector<float> truth;         // [T,Jout,3] m, the true positions
  std::vector<std::uint8_t> valid;  // [T,Jout] 0: the truth is not known
  std::string take, subject, action;
  std::string part;  // name of the split's part, for example "train"
};

/// All pairs of a file, and the names that their arrays refer to. Pairs of all parts of the split
/// are in `all`; Pair::part tells them apart.
struct Pairs {
  std::vector<std::string> inputs, outputs;  // joint names
  double rate_hz = 0.0;
  std::vector<int> parents{};  // [Jout] if the outputs are a skeleton; else empty
  std::vector<Pair> all{};
};

/// The pairs of two streams. The inputs are the joints that a Kinect has too, with the Kinect's
/// names (joint_names.h). If fewer than 10 joints have such a name, the stream is not a Kinect's
/// and all joints are used. Stretches shorter than `least` rows are left out. Fails if a stream or
/// its positions are absent, or if a valid position is not finite.
Result<Pairs> pairs_of(const Windows& windows, const std::string& input, const std::string& truth,
                       std::size_t least);

/// The pairs of two streams for the joints of a model, found by the Kinect's names
/// (kinect_names()). Joints that a stream lacks are missing in the input and not valid in the
/// truth.
Result<Pairs> pairs_for(const Windows& windows, const std::string& input, const std::string& truth,
                        const Pairs& joints, std::size_t least);

/// The joints `wanted` of one stream in a stretch, found by the Kinect's names. Joints that the
/// stream lacks are missing. Fails if the stretch has no such stream.
Result<JointFrames> kinect_frames(const Windows& windows, const Stretch& stretch,
                                  const std::string& stream,
                                  const std::vector<std::string>& wanted);

}  // namespace kinalign
