// SPDX-License-Identifier: Apache-2.0
// What a network that cleans a skeleton sees and says, the same in training and at use. Every
// number is in the body's frame of the input (body_frame.h), so that no truth is needed.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/models/body_frame.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// Joints of both sides, and how the input is brought into the body's frame.
struct DenoiseLayout {
  std::vector<std::string> inputs;   // joints
  std::vector<std::string> outputs;  // joints
  std::vector<int> parents;          // of the outputs: the bones that stay constant; -1: a root
  /// For each output the input joint that the answer begins at; -1: the body's root.
  std::vector<int> bases;
  double rate_hz = 30.0;
  Smoothing smoothing;

  std::size_t channels() const { return 7 * inputs.size(); }
  std::size_t answers() const { return 3 * outputs.size(); }
};

/// The layout for joints by these names. `parents`: of the outputs' skeleton; empty: a Kinect's, by
/// name. The base of an output is the input joint of its name, else that of the next joint above
/// it. Fails where the input has no root or no pair of sides.
Result<DenoiseLayout> denoise_layout(std::vector<std::string> inputs,
                                     std::vector<std::string> outputs, double rate_hz,
                                     std::vector<int> parents = {});

/// For each output the input joint that stands for it, as the base does; where there is none, the
/// root's.
std::vector<std::size_t> inputs_of_outputs(const DenoiseLayout& layout);

/// T frames as a network sees them.
struct DenoiseFeatures {
  /// [T,7J]: positions in the body's frame (3J, m), their differences to the frame before (3J, m),
  /// and whether each joint was seen (J): 1 tracked, 0.5 inferred, 0 missing.
  std::vector<float> input;
  std::vector<float> base;  // [T,Jout,3] m, in the body's frame: the smoothed base joints
  std::vector<BodyFrame> frames;
};

/// `body`: the layout's inputs at its rate.
DenoiseFeatures denoise_features(const DenoiseLayout& layout, JointFrames body);

/// The features of the mirrored body, in its mirrored frames. Partners: of inputs and outputs
/// (mirror_partners()).
void mirror(DenoiseFeatures& features, const std::vector<std::size_t>& inputs,
            const std::vector<std::size_t>& outputs);

/// [T,Jout,3] m from the world's space to the body's frame, and back.
void to_body(const std::vector<BodyFrame>& frames, std::span<float> positions);
void to_world(const std::vector<BodyFrame>& frames, std::span<float> positions);

}  // namespace kinalign
