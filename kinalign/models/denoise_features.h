// SPDX-License-Identifier: Apache-2.0
// Input and output channels of a network that cleans a skeleton, the same in training and in use.
// Every number is in the body's frame of the input (body_frame.h), so no ground truth is needed.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/models/body_frame.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// The joints of the input and of the output, and the settings for the body's frame. The network
/// outputs offsets: an output joint is its base joint plus the offset. The base joints are smoothed
/// input joints. A network that outputs 0 therefore already returns the smoothed input (a residual
/// on a baseline).
struct DenoiseLayout {
  std::vector<std::string> inputs;   // joint names
  std::vector<std::string> outputs;  // joint names
  /// Parent of each output joint; -1: a root. These bones get a constant length.
  std::vector<int> parents;
  /// For each output: the input joint to which the network's offset is added; -1: the body's root.
  std::vector<int> bases;
  double rate_hz = 30.0;
  Smoothing smoothing;

  std::size_t channels() const { return 7 * inputs.size(); }
  std::size_t answers() const { return 3 * outputs.size(); }
};

/// The layout for joints with these names. `parents`: the skeleton of the outputs; empty: the
/// Kinect's skeleton, by name. The base of an output is the input joint of the same name, else that
/// of its nearest ancestor. Fails if the input has no root or no left/right pair.
Result<DenoiseLayout> denoise_layout(std::vector<std::string> inputs,
                                     std::vector<std::string> outputs, double rate_hz,
                                     std::vector<int> parents = {});

/// For each output the input joint that stands for it: its base, or the root if the base is -1.
std::vector<std::size_t> inputs_of_outputs(const DenoiseLayout& layout);

/// The features of T frames. The differences show speeds. The states show which joints are guessed,
/// so that the network can trust them less. The base joints are no input of the network;
/// Denoiser::answer_of() adds the network's offsets to them.
struct DenoiseFeatures {
  /// [T,7J]: positions in the body's frame (3J, m), their differences from the previous frame (3J,
  /// m), and the state of each joint (J): 1 tracked, 0.5 inferred, 0 missing.
  std::vector<float> input;
  std::vector<float> base;  // [T,Jout,3] m, in the body's frame: the smoothed base joints
  std::vector<BodyFrame> frames;
};

/// `body`: frames of the layout's input joints at the layout's rate.
DenoiseFeatures denoise_features(const DenoiseLayout& layout, JointFrames body);

/// Changes the features to those of the mirrored body. `inputs`, `outputs`: the index of each
/// joint's partner on the other side (mirror_partners()).
void mirror(DenoiseFeatures& features, const std::vector<std::size_t>& inputs,
            const std::vector<std::size_t>& outputs);

/// Transforms positions [T,Jout,3] m from the world's space to the body's frame, and back.
void to_body(const std::vector<BodyFrame>& frames, std::span<float> positions);
void to_world(const std::vector<BodyFrame>& frames, std::span<float> positions);

}  // namespace kinalign
