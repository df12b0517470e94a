// SPDX-License-Identifier: Apache-2.0
// A model that cleans skeletons: its networks, and everything needed to use them. Layout of its
// file: docs/formats/model.md.
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

/// What is done to an answer, the same for every method.
struct Steadying {
  bool mirror = true;                 // the mean of the answers to the body and to its mirror image
  Smoothing smoothing{.window = 11};  // of the answer
  bool bones = true;                  // each bone has one length over the take

  bool operator==(const Steadying&) const = default;
};

struct DenoiseModel {
  ModelFacts facts;
  DenoiseLayout layout;
  double answer_scale = 0.05;  // m of a network's 1
  bool states_spread = false;
  double spread_factor = 1.0;  // calibrates the stated spread
  Steadying steadying;
  std::vector<float> input_mean, input_scale;  // [C]
  std::vector<float> answer_mean;              // [3 Jout] m
  Architecture architecture;                   // of the network
  std::optional<Architecture> second;          // of one behind it, from answers to answers
  std::map<std::string, Tensor> tensors;       // "net.", "second." before the names of each
};

/// The bytes of a model's file. The same model gives the same bytes.
std::string write_denoise_model(const DenoiseModel& model);

/// Fails where the file is no model of this kind or its parts do not fit together.
Result<DenoiseModel> read_denoise_model(std::string_view bytes, const std::string& name);

/// The radius that holds 90 % of a Gaussian in space, in standard deviations of an axis.
inline constexpr double radius_90 = 2.5003;

/// A method's answer.
struct Denoised {
  std::vector<float> positions;  // [T,Jout,3] m, in the input's space
  std::vector<float> spread;     // [T,Jout] m per axis (1 sigma); empty where none is stated
};

/// A method as a function: from a body to its answer, in the body's space.
using Answer = std::function<Denoised(const JointFrames& body)>;

/// Steadies answers, the same way for every method: the mean of the answers to a body and to its
/// mirror image, smoothed, with bones of constant length.
class Steadier {
 public:
  Steadier(const Steadying& how, const DenoiseLayout& layout);

  /// `plain`: the answer to `body`. Its spread stays.
  Denoised steadied(const Answer& answer, const JointFrames& body, Denoised plain) const;

 private:
  Steadying how_;
  std::vector<int> parents_;                   // of the outputs
  std::vector<std::size_t> inputs_, outputs_;  // each joint's partner on the other side
};

/// A model ready for use. It can be used by one thread at a time.
class Denoiser {
 public:
  static Result<Denoiser> make(DenoiseModel model);

  const DenoiseModel& model() const { return model_; }

  /// `body`: frames of the layout's inputs at its rate.
  Denoised clean(const JointFrames& body);
  /// The same without the steadying, for comparisons.
  Denoised answer(const JointFrames& body);

  const Network& network() const { return network_; }
  /// Brings features to the scales that the network sees.
  void standardise(DenoiseFeatures& features) const;
  /// What the network's answers [T, outputs] mean, rows `first` ... `end` - 1, in the body's frames
  /// (to_world()). The second network has still to see it, where there is one.
  Denoised answer_of(const DenoiseFeatures& features, std::span<const float> answers,
                     std::size_t first, std::size_t end) const;

 private:
  Denoiser(DenoiseModel model, Network network, std::optional<Network> second);

  DenoiseModel model_;
  Network network_;
  std::optional<Network> second_;
  Workspace workspace_;
  Steadier steadier_;
};

}  // namespace kinalign
