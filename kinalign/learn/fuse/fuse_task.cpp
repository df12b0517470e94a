// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/fuse/fuse_task.h"

#include "kinalign/learn/losses.h"
#include "kinalign/learn/pose/channel_sums.h"
#include "kinalign/learn/tensors.h"
#include "kinalign/motion/mahony.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

// These seeds are fixed, so that scales and validation errors don't depend on the run's seed.
constexpr std::uint64_t fuse_judging_seed = 5, scales_seed = 3;
constexpr std::size_t scales_batches = 8;
constexpr float least_scale_of_fusion = 0.05F;  // flags that hardly vary must not be scaled up

/// If no Kinect sees the person, the person's heading is unknown. The truth is then rotated to the
/// heading of the root's node.
Eigen::Quaternionf truth_turn(const FuseInput& input, const Eigen::Quaternionf& root) {
  const bool is_seen = std::any_of(input.kinect.seen.begin(), input.kinect.seen.end(),
                                   [](std::uint8_t seen) { return seen != 0; });
  const auto measured = orientation_at(input.nodes, 0, input.nodes.nodes - 1);
  if (is_seen || !measured) return Eigen::Quaternionf::Identity();
  const double yaw = heading_of(measured->cast<double>()) - heading_of(root.cast<double>());
  return Eigen::Quaternionf(Eigen::AngleAxisf(static_cast<float>(yaw), Eigen::Vector3f::UnitY()));
}

}  // namespace

// Scales come first: the validation inputs are standardised with them.
FuseTask::FuseTask(FuseLayout layout, FuseTraining training, const FuseData& data,
                   torch::Device device)
    : layout_(std::move(layout)),
      training_(training),
      data_(data),
      device_(device),
      sides_(data.pose.body, data.pose.nodes, layout_.joints),
      crops_(data.pose.learnt, sides_),
      body_(data.pose.body, device) {
  find_scales();
  make_judged();
}

// The validation inputs are standardised with the old scales, so they are made again.
void FuseTask::use_scales(std::vector<float> mean, std::vector<float> scale) {
  input_mean_ = std::move(mean);
  input_scale_ = std::move(scale);
  make_judged();
}

/// Prepares the validation sequences with node errors, but without missing devices or parts.
void FuseTask::make_judged() {
  judged_.clear();
  for (std::size_t i = 0; i < data_.pose.judged.size(); ++i) {
    FuseDraws draws = training_.draws;
    draws.errors.lost_share = 0.0;
    draws.unknown_heading = draws.without_kinect = draws.without_nodes = draws.lost_part = 0.0;
    const PoseSequence& one = data_.pose.judged[i];
    const FuseInput input =
        drawn_input({one.nodes, data_.judged[i].front()}, layout_, draws, fuse_judging_seed, i);
    Rows rows;
    add(one, input, rows);
    judged_.push_back(tensors_of(std::move(rows), 1, one.frames()));
  }
}

/// Appends the features and the truth of one sequence to a batch.
void FuseTask::add(const PoseSequence& sequence, const FuseInput& input, Rows& rows) const {
  const FuseFeatures features = fuse_features(layout_, input);
  rows.input.insert(rows.input.end(), features.input.begin(), features.input.end());
  // In a sequence the waist's node has no error, so its orientation is that of the root.
  const auto roots = true_roots(sequence);
  const std::size_t bones = layout_.nodes.bones.size(), base = 0;  // SpineBase
  const Eigen::Quaternionf turn = truth_turn(input, roots.front());
  for (std::size_t t = 0; t < input.frames(); ++t) {
    const FuseSpace& space = features.space[t];
    const Eigen::Matrix3f from_world = space.turn.toRotationMatrix().transpose();
    const Turn root = from_world * (turn * roots[t]).toRotationMatrix();
    for (std::size_t b = 0; b < bones; ++b) {
      rows.rotations.emplace_back(root * sequence.rotations[t * bones + b]);
    }
    // The root comes after the bones, as in the network's output.
    rows.rotations.push_back(root);
    const Eigen::Vector3f way =
        from_world * (sequence.places[t].cast<float>() - space.place) / fuse_place_unit_m;
    rows.way.insert(rows.way.end(), {way.x(), way.y(), way.z()});
    rows.placed.push_back(input.kinect.seen[t * input.kinect.joints + base] == 0 ? 0.0F : 1.0F);
  }
  for (const Vec3& offset : sequence.rest_offsets) {
    for (const double value : offset) rows.offsets.push_back(static_cast<float>(value));
  }
}

/// Standardises the inputs, and copies a batch to the device.
FuseTask::Batch FuseTask::tensors_of(Rows rows, std::size_t batch, std::size_t frames) const {
  const std::int64_t b = whole(batch), t = whole(frames);
  // When find_scales() draws batches, there are no scales yet.
  if (!input_mean_.empty()) standardise(input_mean_, input_scale_, rows.input);
  return {
      .input = to_torch(rows.input, {b, t, whole(layout_.channels())}).to(device_),
      .rotations = tensor_of(rows.rotations, {b, t, whole(layout_.nodes.bones.size()) + 1, 3, 3})
                       .to(device_),
      .offsets =
          to_torch(rows.offsets, {b, whole(data_.pose.body.skeleton.joints()), 3}).to(device_),
      .way = to_torch(rows.way, {b, t, 3}).to(device_),
      .placed = to_torch(rows.placed, {b, t}).to(device_)};
}

FuseTask::Batch FuseTask::draw(std::uint64_t seed, std::uint64_t step,
                               const BatchPart& part) const {
  const auto first = static_cast<std::size_t>(part.begin);
  const auto batch = static_cast<std::size_t>(part.count), crop = training_.crop;
  Rows rows;
  for (std::size_t k = first; k < first + batch; ++k) {
    const std::uint64_t number = step * training_.batch + k;
    const RandomStream places(seed, number);
    const auto drawn = crops_.draw(places, crop, training_.variety);
    const auto& seen = data_.learnt[drawn.sequence];
    const auto which =
        std::min(static_cast<std::size_t>(places.uniform(0, 2) * static_cast<double>(seen.size())),
                 seen.size() - 1);
    const PoseSequence one = crop_of(data_.pose.learnt[drawn.sequence], drawn.crop, sides_);
    const FuseInput clean{one.nodes, crop_of(seen[which], drawn.crop, sides_)};
    // The seed differs from that of `places`, so that both don't draw the same numbers.
    add(one, drawn_input(clean, layout_, training_.draws, mix64(seed + 1), number), rows);
  }
  return tensors_of(std::move(rows), batch, crop);
}

/// Finds mean and scale of each channel from a few drawn batches.
void FuseTask::find_scales() {
  const std::size_t channels = layout_.channels();
  ChannelSums sums(channels);
  for (std::size_t k = 0; k < scales_batches; ++k) sums.add(values_of(draw(scales_seed, k).input));
  input_mean_.resize(channels);
  input_scale_.resize(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    input_mean_[c] = sums.mean(c);
    input_scale_[c] = std::max(sums.deviation(c), least_scale_of_fusion);
  }
}

/// The weighted sum of four errors: rotations, the root's position, the joints' positions and their
/// accelerations. The last three numbers of the network's output are the vector to the root. All
/// numbers before them are rotations, six for each.
torch::Tensor FuseTask::loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) {
  const BatchPart part = share().part(whole(training_.batch));
  const Batch batch = draw(seed, step, part);
  const auto answers = network.forward(batch.input, part);
  const auto sixes = answers.slice(2, 0, answers.size(2) - 3);
  const auto rotations = rotations_of(sixes);
  const PoseLoss& weights = training_.loss;
  auto out = weights.matrices * part.mean((rotations - batch.rotations).pow(2).sum({-1, -2}));
  // The vector is in dm, the unit of the network's output. If the Kinect does not see SpineBase,
  // the vector begins at an old position and gets the weight 0.
  const auto miss = metres_of(answers.slice(2, answers.size(2) - 3) - batch.way);
  out = out + training_.place * weighted_mean(miss, batch.placed, share());
  const auto error =
      body_.places_of(rotations, batch.offsets) - body_.places_of(batch.rotations, batch.offsets);
  out = out + weights.position * part.mean(metres_of(error));
  return out + weights.acceleration * part.mean(metres_of(second_differences(error)));
}

std::optional<double> FuseTask::judge(const TorchNetwork& network) {
  if (judged_.empty()) return std::nullopt;
  torch::NoGradGuard guard;
  // Only positions are compared: the position of a joint contains the errors of all rotations above
  // it.
  double sum = 0.0, frames = 0.0;
  for (const Batch& one : judged_) {
    const auto answers = network.forward(one.input, false);
    const auto rotations = rotations_of(answers.slice(2, 0, answers.size(2) - 3));
    const auto error =
        body_.places_of(rotations, one.offsets) - body_.places_of(one.rotations, one.offsets);
    // Each frame counts once, however long its sequence is.
    const double count = static_cast<double>(one.input.size(1));
    sum += 100.0 * count * metres_of(error).mean().item<double>();
    frames += count;
  }
  return sum / frames;
}

}  // namespace kinalign
