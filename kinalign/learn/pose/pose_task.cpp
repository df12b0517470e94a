// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/pose_task.h"

#include "kinalign/learn/losses.h"
#include "kinalign/learn/pose/channel_sums.h"
#include "kinalign/learn/tensors.h"
#include "kinalign/models/pose/pose_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

constexpr double length_power = 0.75;  // below 1, because long takes repeat similar motion
constexpr std::uint64_t judging_seed = 5;
constexpr float least_scale = 1e-3F;

}  // namespace

CropDraws::CropDraws(const std::vector<PoseSequence>& sequences, const Sides& sides)
    : can_mirror_(sides.can_mirror) {
  double sum = 0.0;
  for (const PoseSequence& one : sequences) {
    sum += std::pow(static_cast<double>(one.frames()), length_power);
    reached_.push_back(sum);
    frames_.push_back(one.frames());
  }
}

/// Draws a sequence, a variation and a start such that the crop fits into the sequence if possible.
CropDraws::Drawn CropDraws::draw(const RandomStream& random, std::size_t frames,
                                 const Variety& variety) const {
  // The first sequence whose cumulative weight exceeds the number.
  const double weight = random.uniform(0, 0) * reached_.back();
  const auto at = static_cast<std::size_t>(
      std::upper_bound(reached_.begin(), reached_.end() - 1, weight) - reached_.begin());
  Crop crop{.begin = 0, .count = frames, .variation = draw_variation(variety, random)};
  if (!can_mirror_) crop.variation.mirrored = false;
  // A faster crop covers more frames of the sequence.
  const std::size_t covered = crop.source_frames();
  const std::size_t places = frames_[at] > covered ? frames_[at] - covered + 1 : 1;
  const auto begin = static_cast<std::size_t>(random.uniform(0, 1) * static_cast<double>(places));
  crop.begin = std::min(begin, places - 1);
  return {at, crop};
}

PoseTask::PoseTask(PoseLayout layout, PoseTraining training, const PoseData& data,
                   torch::Device device)
    : layout_(std::move(layout)),
      training_(training),
      data_(data),
      device_(device),
      sides_(data.body, data.nodes, {}),
      crops_(data.learnt, sides_),
      body_(data.body, device) {
  find_scales();
  make_judged();
}

void PoseTask::use_scales(std::vector<float> mean, std::vector<float> scale) {
  input_mean_ = std::move(mean);
  input_scale_ = std::move(scale);
  make_judged();
}

/// Makes the inputs of the validation people once. Each validation then has the same errors, so its
/// results can be compared.
void PoseTask::make_judged() {
  judged_.clear();
  for (std::size_t i = 0; i < data_.judged.size(); ++i) {
    const PoseSequence& one = data_.judged[i];
    NodeErrors errors;
    errors.lost_share = 0.0;
    auto input = pose_features(layout_, with_errors(one.nodes, errors, {judging_seed, i})).input;
    standardise(input);
    judged_.push_back(
        {&one, to_torch(input, {1, whole(one.frames()), whole(layout_.channels())}).to(device_)});
  }
}

/// Finds each input channel's mean and deviation over the training people, if the method
/// standardises its inputs. Otherwise mean 0 and scale 1 are kept, because the features have units
/// near 1.
void PoseTask::find_scales() {
  const std::size_t channels = layout_.channels();
  input_mean_.assign(channels, 0.0F);
  input_scale_.assign(channels, 1.0F);
  if (!training_.standardised) return;
  // The nodes have no errors here, because errors are drawn later.
  ChannelSums sums(channels);
  for (const PoseSequence& one : data_.learnt) sums.add(pose_features(layout_, one.nodes).input);
  for (std::size_t c = 0; c < channels; ++c) {
    input_mean_[c] = sums.mean(c);
    input_scale_[c] = std::max(sums.deviation(c), least_scale);
  }
}

void PoseTask::standardise(std::vector<float>& input) const {
  if (training_.standardised) kinalign::standardise(input_mean_, input_scale_, input);
}

/// Draws each crop from its own random streams, so that any process can draw any part.
PoseTask::Batch PoseTask::draw(std::uint64_t seed, std::uint64_t step,
                               const BatchPart& part) const {
  const auto first = static_cast<std::size_t>(part.begin);
  const auto batch = static_cast<std::size_t>(part.count), crop = training_.crop,
             bones = layout_.bones.size();
  std::vector<float> input, offsets;
  std::vector<Turn> rotations;
  for (std::size_t k = first; k < first + batch; ++k) {
    const std::uint64_t number = step * training_.batch + k;
    // One random stream decides on the crop, the other one on its errors.
    const RandomStream places(seed, 2 * number), errors(seed, 2 * number + 1);
    const auto drawn = crops_.draw(places, crop, training_.variety);
    const PoseSequence one = crop_of(data_.learnt[drawn.sequence], drawn.crop, sides_);
    const NodeFrames nodes = with_errors(one.nodes, training_.errors, errors);
    const auto features = pose_features(layout_, nodes).input;
    input.insert(input.end(), features.begin(), features.end());
    rotations.insert(rotations.end(), one.rotations.begin(), one.rotations.end());
    for (const Vec3& offset : one.rest_offsets) {
      for (const double value : offset) offsets.push_back(static_cast<float>(value));
    }
  }
  standardise(input);
  Batch out;
  out.input = to_torch(input, {whole(batch), whole(crop), whole(layout_.channels())}).to(device_);
  out.rotations = tensor_of(rotations, {whole(batch), whole(crop), whole(bones), 3, 3}).to(device_);
  out.offsets =
      to_torch(offsets, {whole(batch), whole(data_.body.skeleton.joints()), 3}).to(device_);
  return out;
}

/// The weighted sum of the errors of rotations, of the joints' positions and of their
/// accelerations.
torch::Tensor PoseTask::loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) {
  const BatchPart part = share().part(whole(training_.batch));
  const Batch batch = draw(seed, step, part);
  const auto rotations = rotations_of(network.forward(batch.input, part));
  const PoseLoss& weights = training_.loss;
  auto out = weights.matrices * part.mean((rotations - batch.rotations).pow(2).sum({-1, -2}));
  if (weights.position <= 0.0 && weights.acceleration <= 0.0) return out;
  // Positions relative to the root, computed for the true body with both sets of rotations.
  const auto error =
      body_.places_of(rotations, batch.offsets) - body_.places_of(batch.rotations, batch.offsets);
  out = out + weights.position * part.mean(metres_of(error));
  if (weights.acceleration > 0.0) {
    out = out + weights.acceleration * part.mean(metres_of(second_differences(error)));
  }
  return out;
}

std::optional<double> PoseTask::judge(const TorchNetwork& network) {
  if (judged_.empty()) return std::nullopt;
  torch::NoGradGuard guard;
  PoseErrors all;
  for (const JudgedSequence& one : judged_) {
    const auto turns = turns_of(rotations_of(network.forward(one.input, false)));
    all.add(pose_errors(data_.body, turns, {one.sequence->rotations, one.sequence->rest_offsets},
                        layout_.rate_hz));
  }
  return all.position_cm + 0.1 * all.sip_deg;
}

}  // namespace kinalign
