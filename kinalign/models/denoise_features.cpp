// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/denoise_features.h"

#include "kinalign/models/joint_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

/// Applies `turn(frame, position)` to every position; each frame has the same number of positions.
template <class Turn>
void move(const std::vector<BodyFrame>& frames, std::span<float> positions, const Turn& turn) {
  if (frames.empty() || positions.size() < frames.size()) return;
  const std::size_t row = positions.size() / frames.size();
  for (std::size_t i = 0; i < row * frames.size(); i += 3) turn(frames[i / row], &positions[i]);
}

/// For each output the input joint of the same name, else the input joint of its nearest ancestor;
/// -1: none. Both lists are compared by Kinect names. A finger that only a suit has thus starts at
/// the wrist or hand of the input.
std::vector<int> inputs_standing_for(const DenoiseLayout& layout) {
  const auto seen = kinect_names(layout.inputs), answered = kinect_names(layout.outputs);
  std::vector<int> out;
  for (std::size_t j = 0; j < answered.size(); ++j) {
    auto found = index_of(seen, answered[j]);
    for (int up = layout.parents[j]; !found && up >= 0;
         up = layout.parents[static_cast<std::size_t>(up)]) {
      found = index_of(seen, answered[static_cast<std::size_t>(up)]);
    }
    out.push_back(found ? static_cast<int>(*found) : -1);
  }
  return out;
}

}  // namespace

Result<DenoiseLayout> denoise_layout(std::vector<std::string> inputs,
                                     std::vector<std::string> outputs, double rate_hz,
                                     std::vector<int> parents) {
  if (!body_joints(inputs)) {
    return Failure(Error{"", 0, "an input with a root (SpineBase, Hips, ...) and both hips",
                         std::to_string(inputs.size()) + " joints without them"});
  }
  DenoiseLayout out;
  out.inputs = std::move(inputs);
  out.outputs = std::move(outputs);
  out.rate_hz = rate_hz;
  out.parents = parents.empty() ? kinect_parents_of(kinect_names(out.outputs)) : std::move(parents);
  out.bases = inputs_standing_for(out);
  // A window of 0.3 s, made odd because the value at its centre is used.
  const auto window = static_cast<std::size_t>(std::lround(rate_hz * 0.3));
  out.smoothing.window = window + (window % 2 == 0 ? 1 : 0);
  return out;
}

std::vector<std::size_t> inputs_of_outputs(const DenoiseLayout& layout) {
  const std::size_t root = body_joints(layout.inputs)->root.front();
  std::vector<std::size_t> out;
  for (const int joint : inputs_standing_for(layout)) {
    out.push_back(joint < 0 ? root : static_cast<std::size_t>(joint));
  }
  return out;
}

DenoiseFeatures denoise_features(const DenoiseLayout& layout, JointFrames body) {
  const std::size_t joints = body.joints, frames = body.frames();
  DenoiseFeatures out;
  // The order matters: gaps are filled before smoothing, and the body's frame is computed from
  // smoothed joints. The network's own input stays unsmoothed.
  fill_missing(body, layout.smoothing.causal);
  JointFrames smoothed = body;
  smooth(layout.smoothing, 3 * joints, smoothed.positions);
  out.frames = body_frames(*body_joints(layout.inputs), smoothed);
  to_body(out.frames, body.positions);
  to_body(out.frames, smoothed.positions);
  out.input.reserve(frames * layout.channels());
  out.base.reserve(frames * layout.answers());
  for (std::size_t t = 0; t < frames; ++t) {
    const float* row = &body.positions[t * joints * 3];
    const float* before = t == 0 ? row : row - joints * 3;
    out.input.insert(out.input.end(), row, row + joints * 3);
    for (std::size_t i = 0; i < joints * 3; ++i) out.input.push_back(row[i] - before[i]);
    for (std::size_t j = 0; j < joints; ++j) {
      // The states are those of the device: a filled gap still counts as missing.
      out.input.push_back(static_cast<float>(body.seen[t * joints + j]) * 0.5F);
    }
    for (const int base : layout.bases) {
      static constexpr std::array<float, 3> root{};
      const float* at =
          base < 0 ? root.data()
                   : &smoothed.positions[(t * joints + static_cast<std::size_t>(base)) * 3];
      out.base.insert(out.base.end(), at, at + 3);
    }
  }
  return out;
}

void mirror(DenoiseFeatures& features, const std::vector<std::size_t>& inputs,
            const std::vector<std::size_t>& outputs) {
  const std::size_t joints = inputs.size();
  for (std::size_t at = 0; at < features.input.size(); at += 7 * joints) {
    const std::span<float> row = std::span(features.input).subspan(at, 7 * joints);
    mirror_positions(row.first(3 * joints), inputs);
    mirror_positions(row.subspan(3 * joints, 3 * joints), inputs);
    for (std::size_t j = 0; j < joints; ++j) {
      if (inputs[j] > j) std::swap(row[6 * joints + j], row[6 * joints + inputs[j]]);
    }
  }
  mirror_positions(features.base, outputs);
}

void to_body(const std::vector<BodyFrame>& frames, std::span<float> positions) {
  move(frames, positions, [](const BodyFrame& frame, float* at) {
    const std::array<float, 3> moved{at[0] - frame.root[0], at[1] - frame.root[1],
                                     at[2] - frame.root[2]};
    const auto turned = frame.turned(moved.data());
    std::copy(turned.begin(), turned.end(), at);
  });
}

void to_world(const std::vector<BodyFrame>& frames, std::span<float> positions) {
  move(frames, positions, [](const BodyFrame& frame, float* at) {
    const auto turned = frame.turned_back(at);
    for (std::size_t k = 0; k < 3; ++k) at[k] = turned[k] + frame.root[k];
  });
}

}  // namespace kinalign
