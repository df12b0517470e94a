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

/// Weights of the terms of the loss. Lengths are in centimetres. The defaults are those of our own
/// method `refine`; other methods set the terms of their publications.
struct DenoiseLoss {
  double distance = 1.0;      // mean distance of joints
  double square = 0.0;        // mean square in dm^2, used by BRA and CNN
  double acceleration = 0.5;  // mean distance of second differences
  double bone = 0.2;          // mean difference of bone lengths
  double smooth = 0.0;        // mean length of the output's second differences
  double spread = 0.1;        // negative log likelihood of the spread, if the network outputs it
  double hands = 1.0;         // factor for wrists, hands and their bones
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
  /// True: `answer_scale` also scales all input positions. False: each input channel has its own
  /// scale.
  bool one_scale = false;
  bool from_truth = false;  // replace the input's joints by the truth where the truth is valid
};

/// Statistics of the training features, stored in the model.
struct DenoiseScales {
  std::vector<float> input_mean, input_scale;  // one number for each input channel
  std::vector<float> answer_mean;              // [3 Jout] m, mean of truth minus base
};

/// Weights [Jout] of the joints in a loss. An output that is a joint of the Kinect counts 1. All
/// other outputs that share one input joint count 1 together. Otherwise the forty finger joints of
/// a suit, which no Kinect sees, would be two thirds of the loss. `hands`: factor for wrists and
/// hands.
std::vector<float> weights_of_outputs(const DenoiseLayout& layout, double hands);

/// Features of all pairs are computed once, in the constructor; a step only cuts crops from them.
/// The scales come from the training pairs alone, so they contain nothing of the validation people.
class DenoiseTask : public TrainingTask {
 public:
  /// `learnt`: pairs to train on. `judged`: pairs of other people for validation; may be empty.
  DenoiseTask(DenoiseLayout layout, DenoiseTraining training, const std::vector<Pair>& learnt,
              const std::vector<Pair>& judged, torch::Device device);

  torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) override;
  std::optional<double> judge(const TorchNetwork& network) override;

  /// The network's joints [B,T,Jout,3] m in the body's frame, for features from denoise_features().
  torch::Tensor answers(const TorchNetwork& network, const torch::Tensor& input,
                        const torch::Tensor& base, bool training) const;

  /// The output with which the network returns its base joints: zeros, and the logarithm of each
  /// joint's actual spread about the base. With another initial spread the likelihood would at
  /// first outweigh all other terms of the loss.
  torch::Tensor first_answer() const;

  /// Ridge regression from the positions of nine frames to the network's output, over all training
  /// pairs. If the network outputs a spread, the bias contains the logarithm of each joint's spread
  /// about the regression.
  LinearAnswer linear_answer() const;

  /// The factor of the network's spread with which 90 % of the training joints are within the 90 %
  /// radius; 1 if the network outputs no spread.
  double spread_factor(const TorchNetwork& network) const;

  const DenoiseScales& scales() const { return scales_; }
  /// Replaces the scales found from the pairs by those of a model, to continue its training.
  void use_scales(DenoiseScales scales);
  /// Sets the features for the loss `hidden`: a function of joints [B,T,3 Jout] m in the body's
  /// frame.
  void compare_features(std::function<torch::Tensor(const torch::Tensor&)> features) {
    features_ = std::move(features);
  }

 private:
  /// The features of one whole stretch, on the CPU. Batches are moved to the device when drawn.
  struct Example {
    // `valid` is 0 or 1 and serves as a weight in each mean.
    torch::Tensor input, base, truth, valid;  // [T,C], [T,Jout,3], [T,Jout,3], [T,Jout]
  };
  struct Batch {
    torch::Tensor input, base, truth, valid;
  };
  Example example_of(const Pair& pair) const;
  Example mirrored(const Pair& pair) const;
  /// Finds the mean and the deviation of each input channel, and the mean offset of the truth from
  /// the base, over all examples.
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
