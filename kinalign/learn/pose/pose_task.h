// SPDX-License-Identifier: Apache-2.0
// Poses from nodes as a task: crops of sequences whose nodes get fresh errors, and their loss.
#pragma once

#include "kinalign/learn/pose/node_errors.h"
#include "kinalign/learn/pose/pose_data.h"
#include "kinalign/learn/trainer.h"
#include "kinalign/models/pose/pose_metrics.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// Weights of the parts.
struct PoseLoss {
  double matrices = 1.0;       // square distance of rotation matrices, summed over their entries
  double position = 5.0;       // distance of joints, m
  double acceleration = 20.0;  // distance of the joints' second differences, m
};

struct PoseTraining {
  PoseLoss loss{};
  NodeErrors errors{};        // drawn anew for each crop
  bool standardised = false;  // channels with mean 0 and deviation 1, as DIP has them
  std::size_t batch = 32, crop = 64;
};

class PoseTask : public TrainingTask {
 public:
  /// `data` must live longer.
  PoseTask(PoseLayout layout, PoseTraining training, const PoseData& data, torch::Device device);

  torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) override;
  /// Position error, cm, and a tenth of the SIP error, degrees, with the errors of a calibration.
  std::optional<double> judge(const TorchNetwork& network) override;

  struct Batch {
    torch::Tensor input;      // [B,T,C] standardised
    torch::Tensor rotations;  // [B,T,bones,3,3]: row k is column k of the rotation
    torch::Tensor offsets;    // [B,J,3] m
  };
  Batch draw(std::uint64_t seed, std::uint64_t step) const;
  /// The rotations, as a batch has them, of a network's answers [B,T,6 bones].
  static torch::Tensor rotations_of(const torch::Tensor& answers);
  /// Positions [B,T,S,3] m of the joints that the loss counts, about the root.
  torch::Tensor places_of(const torch::Tensor& rotations, const torch::Tensor& offsets) const;

  const std::vector<float>& input_mean() const { return input_mean_; }
  const std::vector<float>& input_scale() const { return input_scale_; }

 private:
  void weigh_sequences();
  void find_scales();
  void find_paths();
  void standardise(std::vector<float>& input) const;

  struct JudgedSequence {
    const PoseSequence* sequence;
    torch::Tensor input;  // [1,T,C]
  };

  PoseLayout layout_;
  PoseTraining training_;
  const PoseData& data_;
  torch::Device device_;
  std::vector<double> reached_;  // [sequences] sums of the weights with which they are drawn
  std::vector<float> input_mean_, input_scale_;
  torch::Tensor carriers_;  // [J-1] whose rotation carries joint j+1; the last index: none
  torch::Tensor paths_;     // [S,J-1] 1: the offset of joint j+1 leads to the scored joint
  std::vector<JudgedSequence> judged_;
};

}  // namespace kinalign
