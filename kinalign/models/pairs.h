// SPDX-License-Identifier: Apache-2.0
// Pairs of a rough and a precise stream out of a file of windows.
#pragma once

#include "kinalign/models/joint_frames.h"
#include "kinalign/models/windows_file.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// What both devices saw of one motion, between two gaps of a take. The truth is in the input's
/// space.
struct Pair {
  JointFrames input;
  std::vector<float> truth;         // [T,Jout,3] m
  std::vector<std::uint8_t> valid;  // [T,Jout]
  std::string take, subject, action;
  std::string part;  // of the file's split
};

struct Pairs {
  std::vector<std::string> inputs, outputs;  // joints
  double rate_hz = 0.0;
  std::vector<int> parents{};  // of the outputs, where their stream is a skeleton; else empty
  std::vector<Pair> all{};
};

/// Of the input the joints that a Kinect has too, by its names (joint_names.h); all joints where
/// the stream is no Kinect's. Fails where the file lacks a stream or its positions, and where
/// a valid position is not finite. Stretches shorter than `least` rows are left out.
Result<Pairs> pairs_of(const Windows& windows, const std::string& input, const std::string& truth,
                       std::size_t least);

/// The same for the joints of a model, by the Kinect's names for them (kinect_names()). Joints that
/// a stream lacks are missing in the input and not valid in the truth.
Result<Pairs> pairs_for(const Windows& windows, const std::string& input, const std::string& truth,
                        const Pairs& joints, std::size_t least);

/// What a Kinect's stream says in a stretch, of the joints `wanted` by its names; those that it
/// lacks are missing. Fails where the stretch has no such stream.
Result<JointFrames> kinect_frames(const Windows& windows, const Stretch& stretch,
                                  const std::string& stream,
                                  const std::vector<std::string>& wanted);

}  // namespace kinalign
