// SPDX-License-Identifier: Apache-2.0
// Fusion as a task: crops of what both devices say, and the loss of a pose in their world.
#pragma once

#include "kinalign/learn/fuse/fuse_data.h"
#include "kinalign/learn/fuse/fuse_draws.h"
#include "kinalign/learn/pose/pose_task.h"
#include "kinalign/models/fuse/fuse_model.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

struct FuseTraining {
  PoseLoss loss{};
  double place = 1.0;  // weight of the root's distance to its place, dm; where a Kinect sees it
  FuseDraws draws{};
  Variety variety{};
  std::size_t batch = 32, crop = 64;
};

class FuseTask : public TrainingTask {
 public:
  /// `data` must live longer.
  FuseTask(FuseLayout layout, FuseTraining training, const FuseData& data, torch::Device device);

  torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) override;
  /// Position error about the root, cm, with both devices, or with the one that the method sees.
  std::optional<double> judge(const TorchNetwork& network) override;

  struct Batch {
    torch::Tensor input;      // [B,T,C] standardised
    torch::Tensor rotations;  // [B,T,bones+1,3,3] in the space of the frame, the root's last
    torch::Tensor offsets;    // [B,J,3] m
    torch::Tensor way;        // [B,T,3] dm from the Kinect's SpineBase to the root, in that space
    torch::Tensor placed;     // [B,T] 1 where the Kinect sees it
  };
  Batch draw(std::uint64_t seed, std::uint64_t step) const { return draw(seed, step, all()); }
  /// These examples of it.
  Batch draw(std::uint64_t seed, std::uint64_t step, const BatchPart& part) const;

  /// In place of those of the data: a model's, to go on from it.
  void use_scales(std::vector<float> mean, std::vector<float> scale);
  const std::vector<float>& input_mean() const { return input_mean_; }
  const std::vector<float>& input_scale() const { return input_scale_; }

 private:
  /// Arrays of a batch while it is filled.
  struct Rows {
    std::vector<float> input, offsets, way, placed;
    std::vector<Turn> rotations;
  };
  BatchPart all() const { return BatchShare().part(static_cast<std::int64_t>(training_.batch)); }
  void add(const PoseSequence& sequence, const FuseInput& input, Rows& rows) const;
  Batch tensors_of(Rows rows, std::size_t batch, std::size_t frames) const;
  void find_scales();
  void make_judged();

  FuseLayout layout_;
  FuseTraining training_;
  const FuseData& data_;
  torch::Device device_;
  Sides sides_;
  CropDraws crops_;
  BodyTensors body_;
  std::vector<float> input_mean_, input_scale_;
  std::vector<Batch> judged_;  // a sequence each
};

}  // namespace kinalign
