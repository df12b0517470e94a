// SPDX-License-Identifier: Apache-2.0
// Poses from nodes as a training task: crops of sequences with fresh node errors, and their loss.
#pragma once

#include "kinalign/learn/pose/body_tensors.h"
#include "kinalign/learn/pose/crops.h"
#include "kinalign/learn/pose/node_errors.h"
#include "kinalign/learn/pose/pose_data.h"
#include "kinalign/learn/trainer.h"
#include "kinalign/models/pose/pose_metrics.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// Weights of the terms of the loss. Positions and accelerations are computed with the body, so an
/// error near the root counts for all joints below it.
struct PoseLoss {
  double matrices = 1.0;       // squared distance of rotation matrices, summed over their entries
  double position = 5.0;       // distance of joints, m
  double acceleration = 20.0;  // distance of the joints' second differences, m
};

struct PoseTraining {
  PoseLoss loss{};
  NodeErrors errors{};        // drawn again for each crop
  Variety variety{};          // drawn again for each crop
  bool standardised = false;  // scale channels to mean 0 and deviation 1, as DIP does
  std::size_t batch = 32, crop = 64;
};

/// Draws training sequences, longer ones more often, and random crops of them.
class CropDraws {
 public:
  CropDraws(const std::vector<PoseSequence>& sequences, const Sides& sides);

  struct Drawn {
    std::size_t sequence = 0;
    Crop crop;
  };
  Drawn draw(const RandomStream& random, std::size_t frames, const Variety& variety) const;

 private:
  bool can_mirror_;
  // Lengths of the sequences: a drawn crop must fit into its sequence.
  std::vector<std::size_t> frames_;
  std::vector<double> reached_;  // cumulative weights of the sequences
};

/// Crops are cut and get their errors when a batch is drawn, so no crop occurs twice. Validation
/// inputs are made once.
class PoseTask : public TrainingTask {
 public:
  /// `data` must outlive this object.
  PoseTask(PoseLayout layout, PoseTraining training, const PoseData& data, torch::Device device);

  torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) override;
  /// Position error, cm, plus a tenth of the SIP error, degrees, with the errors of a calibration.
  std::optional<double> judge(const TorchNetwork& network) override;

  struct Batch {
    torch::Tensor input;      // [B,T,C] standardised
    torch::Tensor rotations;  // [B,T,bones,3,3] (rotations_of())
    torch::Tensor offsets;    // [B,J,3] m, rest offsets of the person's joints
  };
  Batch draw(std::uint64_t seed, std::uint64_t step) const { return draw(seed, step, all()); }
  /// Draws the given part of a batch.
  Batch draw(std::uint64_t seed, std::uint64_t step, const BatchPart& part) const;
  /// Replaces the scales found from the data by those of a model, to continue its training.
  void use_scales(std::vector<float> mean, std::vector<float> scale);
  const std::vector<float>& input_mean() const { return input_mean_; }
  const std::vector<float>& input_scale() const { return input_scale_; }

 private:
  BatchPart all() const { return BatchShare().part(static_cast<std::int64_t>(training_.batch)); }
  void find_scales();
  void make_judged();
  void standardise(std::vector<float>& input) const;

  struct JudgedSequence {
    const PoseSequence* sequence;
    torch::Tensor input;  // [1,T,C]
  };

  PoseLayout layout_;
  PoseTraining training_;
  const PoseData& data_;
  torch::Device device_;
  Sides sides_;
  CropDraws crops_;
  std::vector<float> input_mean_, input_scale_;
  BodyTensors body_;
  std::vector<JudgedSequence> judged_;
};

}  // namespace kinalign
