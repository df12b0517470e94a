// SPDX-License-Identifier: Apache-2.0
// A model that cleans skeletons: its networks and all settings needed to use them. The file's
// layout: docs/formats/model.md.
#pragma once

#include "kinalign/infer/network.h"
#include "kinalign/models/denoise_features.h"
#include "kinalign/models/model_facts.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// Post-processing of the joints that a network or a filter returns, the same for every method.
struct Steadying {
  bool mirror = true;                 // average the results for the body and for its mirror image
  Smoothing smoothing{.window = 11};  // smoothing of the result over time
  bool bones = true;                  // give each bone one length over the whole take

  bool operator==(const Steadying&) const = default;
};

/// Everything that training decides and that use must repeat: the layout of joints, the scales, the
/// networks and the post-processing. Denoiser::make() checks that the networks fit the layout.
struct DenoiseModel {
  ModelFacts facts;
  DenoiseLayout layout;
  double answer_scale = 0.05;  // metres per unit of the network's output
  bool states_spread = false;  // the network also outputs each joint's expected error (spread)
  double spread_factor = 1.0;  // corrects the spread that the network outputs
  Steadying steadying;
  std::vector<float> input_mean, input_scale;  // one number for each input channel
  std::vector<float> answer_mean;              // [3 Jout] m, mean of truth minus base
  Architecture architecture;                   // the first network ("net")
  std::optional<Architecture> second;          // optional network that refines the joints
  std::map<std::string, Tensor> tensors;       // names begin with "net." or "second."
};

/// The bytes of a model's file. The same model gives the same bytes.
std::string write_denoise_model(const DenoiseModel& model);

/// Fails if the file is not a model of this task or its parts do not fit together.
Result<DenoiseModel> read_denoise_model(std::string_view bytes, const std::string& name);

/// The radius of the sphere that holds 90 % of a Gaussian in three dimensions, in standard
/// deviations per axis.
inline constexpr double radius_90 = 2.5003;

/// The joints that a method returns for its input.
struct Denoised {
  std::vector<float> positions;  // [T,Jout,3] m, in the input's space
  std::vector<float> spread;  // [T,Jout] m per axis (1 sigma); empty if the method states no spread
};

/// A method as a function: from a body to its cleaned joints, in the same space. The networks of
/// models and the filters without learning (filters.h) have this form, so that all of them get the
/// same post-processing in comparisons.
using Answer = std::function<Denoised(const JointFrames& body)>;

/// Post-processes the joints of any method: averages the results for a body and for its mirror
/// image, smooths them, and gives bones constant lengths.
class Steadier {
 public:
  Steadier(const Steadying& how, const DenoiseLayout& layout);

  /// Returns `plain`, the result for `body`, with post-processed positions. `answer` is called
  /// again for the mirror image. The spread is not changed.
  Denoised steadied(const Answer& answer, const JointFrames& body, Denoised plain) const;

 private:
  Steadying how_;
  std::vector<int> parents_;                   // parent of each output joint
  std::vector<std::size_t> inputs_, outputs_;  // each joint's partner on the other side
};

/// A model ready for use. It can be used by one thread at a time.
/// Users call clean(). Its steps are public because LiveCleaner runs them over a moving window.
class Denoiser {
 public:
  static Result<Denoiser> make(DenoiseModel model);

  const DenoiseModel& model() const { return model_; }

  /// `body`: frames of the layout's input joints at the layout's rate. Returns post-processed
  /// joints.
  Denoised clean(const JointFrames& body);
  /// The network's joints without post-processing, for comparisons.
  Denoised answer(const JointFrames& body);

  const Network& network() const { return network_; }
  /// Scales the features as in training: subtracts the mean, divides by the scale.
  void standardise(DenoiseFeatures& features) const;
  /// Converts the network's output [T, outputs], rows `first` ... `end` - 1, to joints in the
  /// body's frames (to_world() brings them to the world). apply_second() comes next.
  Denoised answer_of(const DenoiseFeatures& features, std::span<const float> answers,
                     std::size_t first, std::size_t end) const;
  /// Replaces the joints, in the body's frames, by the output of the second network. Without a
  /// second network nothing changes.
  void apply_second(Denoised& answer);

 private:
  Denoiser(DenoiseModel model, Network network, std::optional<Network> second);

  DenoiseModel model_;
  Network network_;
  std::optional<Network> second_;
  Workspace workspace_;
  Steadier steadier_;
};

}  // namespace kinalign
