// SPDX-License-Identifier: Apache-2.0
// Cleaning skeletons as a training task: pairs of input and truth, their batches, and their loss.
#pragma once

#include "kinalign/learn/linear_answer.h"
#include "kinalign/learn/trainer.h"
#include "kinalign/models/denoise_features.h"
#include "kinalign/models/pairs.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Weights of the terms of the loss. Lengths are in centimetres.
/// Defaults are those of our own method; other methods set the terms of their papers.
struct DenoiseLoss {
  double distance = 1.0;      // mean distance of joints
  double square = 0.0;        // mean square in dm^2, used by BRA and CNN
  double acceleration = 0.5;  // mean distance of second differences
  double bone = 0.2;          // mean difference of bone lengths
  double smooth = 0.0;        // mean length of the answer's second differences
  double spread = 0.1;  // negative log likelihood of the stated spread, if the network states one
  double hands = 1.0;   // factor for wrists, hands and their bones
  double hidden = 0.0;  // BRA-P: squared difference of the features of the network of clean motion
};

/// Everything that a method decides about its data and loss. `crop` is in frames; the default of 61
/// covers two seconds at 30 Hz.
struct DenoiseTraining {
  DenoiseLoss loss{};
  std::int64_t batch = 32, crop = 61;
  bool mirror = true;  // add the mirror image of each pair
  /// The last Jout channels are the logarithm of each joint's spread, cm.
  bool states_spread = false;
  double answer_scale = 0.05;  // metres per unit of the network's output
  /// `answer_scale` is also the scale of all input positions; else each channel has its own.
  bool one_scale = false;
  bool from_truth = false;  // replace the input's joints by the truth where the truth is valid
};

/// Statistics of the training features, stored in the model.
struct DenoiseScales {
  std::vector<float> input_mean, input_scale;  // [C]
  std::vector<float> answer_mean;              // [3 Jout] m, mean of truth minus base
};

/// Weights [Jout] of the joints in a loss. An output that is a joint of the Kinect counts 1. Other
/// outputs that share one input joint count 1 together: otherwise the forty finger joints of a suit
/// would be two thirds of the loss, and no Kinect sees them. `hands`: factor for wrists and hands.
std::vector<float> weights_of_outputs(const DenoiseLayout& layout, double hands);

/// Features of all pairs are computed once, in the constructor; a step only cuts crops from them.
/// Scales come from the training pairs alone, so that judged people stay unknown.
class DenoiseTask : public TrainingTask {
 public:
  /// `learnt`: pairs to train on. `judged`: pairs of other people for validation; may be empty.
  DenoiseTask(DenoiseLayout layout, DenoiseTraining training, const std::vector<Pair>& learnt,
              const std::vector<Pair>& judged, torch::Device device);

  torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) override;
  std::optional<double> judge(const TorchNetwork& network) override;

  /// The answers [B,T,Jout,3] m in the body's frame, for features from denoise_features().
  torch::Tensor answers(const TorchNetwork& network, const torch::Tensor& input,
                        const torch::Tensor& base, bool training) const;

  /// The output of a network whose answer is the base: zeros, and the logarithm of each joint's
  /// actual spread about the base. With another initial spread the likelihood would outweigh all
  /// other losses at first.
  torch::Tensor first_answer() const;

  /// Ridge regression from the positions of nine frames to the answers, over all training pairs. If
  /// a spread is stated, the bias contains the logarithm of each joint's spread about the
  /// regression.
  LinearAnswer linear_answer() const;

  /// The factor for the stated spread that puts 90 % of the training pairs within the 90 % radius;
  /// 1 if no spread is stated.
  double spread_factor(const TorchNetwork& network) const;

  const DenoiseScales& scales() const { return scales_; }
  /// Replaces the scales found from the pairs by those of a model, to continue its training.
  void use_scales(DenoiseScales scales);
  /// Sets the features for the loss `hidden`: a function of answers [B,T,3 Jout] m in the body's
  /// frame.
  void compare_features(std::function<torch::Tensor(const torch::Tensor&)> features) {
    features_ = std::move(features);
  }

 private:
  /// The features of one sequence.
  /// A whole stretch on the CPU; batches are moved to the device when they are drawn.
  struct Example {
    // `valid` is 0 or 1 and serves as a weight in each mean.
    torch::Tensor input, base, truth, valid;  // [T,C], [T,Jout,3], [T,Jout,3], [T,Jout]
  };
  struct Batch {
    torch::Tensor input, base, truth, valid;
  };
  Example example_of(const Pair& pair) const;
  Example mirrored(const Pair& pair) const;
  /// Finds the mean and the deviation of each input channel, and the answers' mean offset from the
  /// base, over all examples.
  void set_scales();
  void put_truth_in(Example& one) const;
  Batch draw(std::uint64_t seed, std::uint64_t step, const BatchPart& part) const;
  /// The loss of one part of a batch, weighted by its share of the batch.
  torch::Tensor weigh(const Batch& batch, const BatchPart& part, const torch::Tensor& answer,
                      const torch::Tensor& spread) const;

  DenoiseLayout layout_;
  DenoiseTraining training_;
  std::vector<std::size_t> input_partners_, output_partners_;
  /// Per pair: the example, and its mirror image if used.
  std::vector<std::vector<Example>> examples_;
  std::vector<Example> judged_;
  DenoiseScales scales_;
  torch::Tensor input_mean_, input_scale_, answer_mean_, joint_weights_, bone_weights_, bone_ends_,
      bone_begins_;
  torch::Device device_;
  std::function<torch::Tensor(const torch::Tensor&)> features_;
};

}  // namespace kinalign
