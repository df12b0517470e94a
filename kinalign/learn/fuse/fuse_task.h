// SPDX-License-Identifier: Apache-2.0
// Fusion as a training task: crops of both devices' data, and the loss of a pose in the world.
#pragma once

#include "kinalign/learn/fuse/fuse_data.h"
#include "kinalign/learn/fuse/fuse_draws.h"
#include "kinalign/learn/pose/pose_task.h"
#include "kinalign/models/fuse/fuse_model.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// `crop` is in frames: 64 are about two seconds at 30 Hz.
struct FuseTraining {
  PoseLoss loss{};
  /// Weight of the root's position error, dm; only in frames in which the Kinect sees the root.
  double place = 1.0;
  FuseDraws draws{};
  Variety variety{};
  std::size_t batch = 32, crop = 64;
};

/// The network's output is in the space of each frame, and so is the truth. That space depends on
/// the errors of the input, so it is found again for each crop.
class FuseTask : public TrainingTask {
 public:
  /// `data` must outlive this object.
  FuseTask(FuseLayout layout, FuseTraining training, const FuseData& data, torch::Device device);

  torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) override;
  /// Mean position error relative to the root, cm, with the devices that the method uses.
  std::optional<double> judge(const TorchNetwork& network) override;

  struct Batch {
    torch::Tensor input;  // [B,T,C] standardised
    /// [B,T,bones+1,3,3] in the space of the frame; the last one is the root's.
    torch::Tensor rotations;
    torch::Tensor offsets;  // [B,J,3] m, rest offsets of the person's joints
    /// [B,T,3] dm from the Kinect's SpineBase to the root, in the space of the frame.
    torch::Tensor way;
    torch::Tensor placed;  // [B,T] 1 if the Kinect sees SpineBase, else 0
  };
  Batch draw(std::uint64_t seed, std::uint64_t step) const { return draw(seed, step, all()); }
  /// Draws the given part of a batch.
  Batch draw(std::uint64_t seed, std::uint64_t step, const BatchPart& part) const;

  /// Replaces the scales found from the data by those of a model, to continue its training.
  void use_scales(std::vector<float> mean, std::vector<float> scale);
  const std::vector<float>& input_mean() const { return input_mean_; }
  const std::vector<float>& input_scale() const { return input_scale_; }

 private:
  /// Arrays of a batch under construction.
  /// [B,T,...] in order; add() appends one sequence after another.
  struct Rows {
    std::vector<float> input, offsets, way, placed;
    std::vector<Turn> rotations;
  };
  BatchPart all() const { return BatchShare().part(static_cast<std::int64_t>(training_.batch)); }
  void add(const PoseSequence& sequence, const FuseInput& input, Rows& rows) const;
  Batch tensors_of(Rows rows, std::size_t batch, std::size_t frames) const;
  // The constructor calls these two functions in this order.
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
  std::vector<Batch> judged_;  // one sequence each
};

}  // namespace kinalign
