// SPDX-License-Identifier: Apache-2.0
// A model that cleans skeletons: its networks, and everything needed to use them. Layout of its
// file: docs/formats/model.md.
#pragma once

#include "kinalign/infer/network.h"
#include "kinalign/models/denoise_features.h"
#include "kinalign/models/model_facts.h"

#include <optional>
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

/// What a model answers.
struct Denoised {
  std::vector<float> positions;  // [T,Jout,3] m, in the input's space
  std::vector<float> spread;     // [T,Jout] m per axis (1 sigma); empty where none is stated
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

 private:
  Denoiser(DenoiseModel model, Network network, std::optional<Network> second);
  Denoised answer_once(const JointFrames& body);

  DenoiseModel model_;
  Network network_;
  std::optional<Network> second_;
  Workspace workspace_;
  std::vector<std::size_t> input_partners_, output_partners_;
};

/// Mirrors what a model answered to a mirrored body.
void mirror_answer(Denoised& answer, const std::vector<std::size_t>& partners);

/// Smoothing and bones of constant length, in place: the same for every method.
void steady(const Steadying& how, const std::vector<int>& parents,
            const std::vector<std::size_t>& partners, std::vector<float>& positions);

}  // namespace kinalign
