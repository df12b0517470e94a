// SPDX-License-Identifier: Apache-2.0
// Cleaning skeletons as a task: pairs of an input and its truth, batches of them, their loss.
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

/// What the answers are held against, each in centimetres and with its weight.
struct DenoiseLoss {
  double distance = 1.0;      // mean distance of joints
  double square = 0.0;        // mean square, in dm^2: BRA's and CNN's
  double acceleration = 0.5;  // distance of second differences
  double bone = 0.2;          // difference of bone lengths
  double smooth = 0.0;        // length of the answer's own second differences
  double spread = 0.1;        // negative log likelihood of the stated spread, if it is stated
  double hands = 1.0;         // weight of wrists, hands and their bones beside the others'
  double hidden = 0.0;        // BRA-P: difference of the features of a network that knows motion
};

struct DenoiseTraining {
  DenoiseLoss loss{};
  std::int64_t batch = 32, crop = 61;
  bool mirror = true;
  bool states_spread = false;  // the last Jout channels are the logarithm of each joint's spread
  double answer_scale = 0.05;  // m of a network's 1
  bool one_scale = false;      // of the input's positions too; else each channel has its own
  bool from_truth = false;     // the truth is the input as well, where the Kinect sees its joints
};

/// Numbers of the training people's features, which the model keeps.
struct DenoiseScales {
  std::vector<float> input_mean, input_scale;  // [C]
  std::vector<float> answer_mean;              // [3 Jout] m, of truth minus base
};

/// [Jout] of joints in a loss. Outputs of the Kinect's own joints count 1. The others that one
/// input joint stands for count 1 together: a suit's forty joints of fingers would be two thirds of
/// the loss, and no Kinect sees them. `hands`: a factor of wrists and hands.
std::vector<float> weights_of_outputs(const DenoiseLayout& layout, double hands);

class DenoiseTask : public TrainingTask {
 public:
  /// `judged`: of people who are not trained on; may be empty. `known`: for the loss `hidden`, a
  /// network from [B,T,3 Jout] answers in the body's frame, m, to features.
  DenoiseTask(DenoiseLayout layout, DenoiseTraining training, const std::vector<Pair>& learnt,
              const std::vector<Pair>& judged, torch::Device device);

  torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) override;
  std::optional<double> judge(const TorchNetwork& network) override;

  /// The answers [B,T,Jout,3] m, in the body's frame, to features as denoise_features() gives them.
  torch::Tensor answers(const TorchNetwork& network, const torch::Tensor& input,
                        const torch::Tensor& base, bool training) const;

  /// What a network says that answers with the base: zeros, and the logarithm of each joint's own
  /// spread about it. With another spread the likelihood outweighs all other losses at first.
  torch::Tensor first_answer() const;

  /// The answers by ridge regression on the positions of nine frames, over all that is learnt; with
  /// the logarithm of each joint's spread about them, where a spread is stated.
  LinearAnswer linear_answer() const;

  /// By what the stated spread must be multiplied so that 90 % of the pairs that were learnt lie
  /// within the 90 % radius; 1 where none is stated.
  double spread_factor(const TorchNetwork& network) const;

  const DenoiseScales& scales() const { return scales_; }
  /// In place of those of the pairs: a model's, to go on from it.
  void use_scales(DenoiseScales scales);
  void compare_features(std::function<torch::Tensor(const torch::Tensor&)> features) {
    features_ = std::move(features);
  }

 private:
  /// A sequence as the network sees it, once as it is and once mirrored.
  struct Example {
    torch::Tensor input, base, truth, valid;  // [T,C], [T,Jout,3], [T,Jout,3], [T,Jout]
  };
  struct Batch {
    torch::Tensor input, base, truth, valid;
  };
  Example example_of(const Pair& pair) const;
  Example mirrored(const Pair& pair) const;
  void set_scales();
  void put_truth_in(Example& one) const;
  Batch draw(std::uint64_t seed, std::uint64_t step, const BatchPart& part) const;
  /// `part`: of the batch, whose share of the loss it is.
  torch::Tensor weigh(const Batch& batch, const BatchPart& part, const torch::Tensor& answer,
                      const torch::Tensor& spread) const;

  DenoiseLayout layout_;
  DenoiseTraining training_;
  std::vector<std::size_t> input_partners_, output_partners_;
  std::vector<std::vector<Example>> examples_;  // one or two of each pair
  std::vector<Example> judged_;
  DenoiseScales scales_;
  torch::Tensor input_mean_, input_scale_, answer_mean_, joint_weights_, bone_weights_, bone_ends_,
      bone_begins_;
  torch::Device device_;
  std::function<torch::Tensor(const torch::Tensor&)> features_;
};

}  // namespace kinalign
