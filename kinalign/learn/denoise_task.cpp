// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/denoise_task.h"

#include "kinalign/learn/losses.h"
#include "kinalign/learn/tensors.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/simulate/random.h"

#include <algorithm>
#include <string_view>

namespace kinalign {

namespace {

constexpr double centimetres = 100.0;
// The scale of a joint that hardly moves has this lower limit; otherwise its noise would be scaled
// up.
constexpr double least_position_scale = 0.01, least_step_scale = 0.001;  // m
/// Random numbers reserved for each example of a batch.
constexpr std::uint64_t lanes_per_example = 8;
/// Degrees of freedom of Student's t distribution in three dimensions, by which the stated spread
/// is learnt (Lange, Little and Taylor 1989 use 4 if they are not estimated).
constexpr double student_freedom = 4.0;
constexpr std::int64_t linear_kernel = 9;  // 0.3 s at 30 Hz
constexpr double linear_penalty = 300.0;

bool is_hand(const std::string& name) {
  for (const std::string_view word :
       {"Wrist", "Hand", "Thumb", "Finger", "wrist", "hand", "thumb", "finger"}) {
    if (name.find(word) != std::string::npos) return true;
  }
  return false;
}

/// Rows begin ... begin + count - 1 of `x`. If `x` is shorter, its last row is repeated.
/// Callers give the repeated rows the weight 0.
torch::Tensor rows(const torch::Tensor& x, std::int64_t begin, std::int64_t count) {
  const auto piece = x.slice(0, begin, begin + count);
  const std::int64_t missing = count - piece.size(0);
  if (missing == 0) return piece;
  std::vector<std::int64_t> shape(piece.sizes().begin(), piece.sizes().end());
  shape[0] = missing;
  return torch::cat({piece, piece.slice(0, piece.size(0) - 1).expand(shape)});
}

}  // namespace

std::vector<float> weights_of_outputs(const DenoiseLayout& layout, double hands) {
  const auto inputs = inputs_of_outputs(layout);
  std::vector<float> out;
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    // The first output that stands for an input joint is that joint itself. All other outputs that
    // stand for it share the weight of one joint.
    const auto same = std::count(inputs.begin(), inputs.end(), inputs[j]);
    const bool is_own = std::find(inputs.begin(), inputs.end(), inputs[j]) - inputs.begin() ==
                        static_cast<std::ptrdiff_t>(j);
    const float share = is_own ? 1.0F : 1.0F / static_cast<float>(same - 1);
    out.push_back(share * (is_hand(layout.outputs[j]) ? static_cast<float>(hands) : 1.0F));
  }
  return out;
}

/// Computes the features of all pairs, the scales, and the weights of joints and bones.
DenoiseTask::DenoiseTask(DenoiseLayout layout, DenoiseTraining training,
                         const std::vector<Pair>& learnt, const std::vector<Pair>& judged,
                         torch::Device device)
    : layout_(std::move(layout)),
      training_(training),
      input_partners_(mirror_partners(layout_.inputs)),
      output_partners_(mirror_partners(layout_.outputs)),
      device_(device) {
  for (const Pair& pair : learnt) {
    examples_.push_back({example_of(pair)});
    if (training_.mirror) examples_.back().push_back(mirrored(pair));
  }
  for (const Pair& pair : judged) judged_.push_back(example_of(pair));
  set_scales();
  const std::vector<float> weights = weights_of_outputs(layout_, training_.loss.hands);
  std::vector<float> bone_weights;
  std::vector<std::int64_t> ends, begins;
  for (std::size_t j = 0; j < layout_.outputs.size(); ++j) {
    if (layout_.parents[j] < 0) continue;
    ends.push_back(whole(j));
    begins.push_back(layout_.parents[j]);
    bone_weights.push_back(weights[j]);
  }
  // The weights are scaled to a mean of 1. They then change neither the learning rate nor the
  // balance of the loss terms.
  const auto of_mean_one = [&](const std::vector<float>& values) {
    const auto tensor = torch::tensor(values);
    return (tensor / tensor.mean()).to(device_);
  };
  joint_weights_ = of_mean_one(weights);
  bone_weights_ = of_mean_one(bone_weights);
  bone_ends_ = torch::tensor(ends, torch::kInt64).to(device_);
  bone_begins_ = torch::tensor(begins, torch::kInt64).to(device_);
}

// The truth is transformed into the body's frame of the input. Errors of root and heading thus
// remain in the loss, and the network can correct them.
DenoiseTask::Example DenoiseTask::example_of(const Pair& pair) const {
  const DenoiseFeatures features = denoise_features(layout_, pair.input);
  std::vector<float> truth = pair.truth;
  to_body(features.frames, truth);
  const std::int64_t frames = whole(pair.input.frames()), joints = whole(layout_.outputs.size());
  return {to_torch(features.input, {frames, whole(layout_.channels())}),
          to_torch(features.base, {frames, joints, 3}), to_torch(truth, {frames, joints, 3}),
          to_torch(std::vector<float>(pair.valid.begin(), pair.valid.end()), {frames, joints})};
}

// The body is mirrored in the world and its features are computed again, because the body's frame
// is mirrored, too.
DenoiseTask::Example DenoiseTask::mirrored(const Pair& pair) const {
  Pair other = pair;
  mirror(other.input, input_partners_);
  JointFrames truth{layout_.outputs.size(), std::move(other.truth), std::move(other.valid)};
  mirror(truth, output_partners_);
  other.truth = std::move(truth.positions);
  other.valid = std::move(truth.seen);
  return example_of(other);
}

void DenoiseTask::use_scales(DenoiseScales scales) {
  scales_ = std::move(scales);
  const auto on_device = [&](const std::vector<float>& values) {
    return to_torch(values, {whole(values.size())}).to(device_);
  };
  input_mean_ = on_device(scales_.input_mean);
  input_scale_ = on_device(scales_.input_scale);
  answer_mean_ = on_device(scales_.answer_mean).reshape({-1, 3});
  if (!training_.from_truth) return;
  for (auto& variants : examples_) {
    for (Example& one : variants) put_truth_in(one);
  }
}

void DenoiseTask::set_scales() {
  std::vector<torch::Tensor> inputs;
  torch::Tensor sum, count;
  for (const auto& variants : examples_) {
    for (const Example& one : variants) {
      inputs.push_back(one.input);
      // The sums are double, because a float would lose digits over hundreds of thousands of
      // frames.
      const auto weights = one.valid.unsqueeze(-1);
      const auto offsets = ((one.truth - one.base) * weights).to(torch::kFloat64).sum(0);
      const auto counts = weights.to(torch::kFloat64).sum(0);
      sum = sum.defined() ? sum + offsets : offsets;
      count = count.defined() ? count + counts : counts;
    }
  }
  const auto all = torch::cat(inputs).to(torch::kFloat64);
  const std::int64_t positions = 3 * whole(layout_.inputs.size());
  auto scale = all.std(0);
  scale.slice(0, 0, positions).clamp_min_(least_position_scale);
  if (training_.one_scale) scale.slice(0, 0, positions).fill_(training_.answer_scale);
  scale.slice(0, positions, 2 * positions).clamp_min_(least_step_scale);
  // States are not scaled, because they are between 0 and 1 already.
  scale.slice(0, 2 * positions).fill_(1.0);
  use_scales({values_of(all.mean(0)), values_of(scale), values_of(sum / count.clamp_min(1.0))});
}

/// Replaces input joints by the input's mean plus the deviation of the truth from its own mean. If
/// several outputs stand for one input joint, the first one is used, which has the joint's own
/// name.
void DenoiseTask::put_truth_in(Example& one) const {
  const auto inputs = inputs_of_outputs(layout_);
  const auto mean = to_torch(scales_.input_mean, {whole(scales_.input_mean.size())});
  const auto offsets = one.truth - (one.base + answer_mean_.cpu());
  // The loop runs backwards, so that the first output is written last and remains.
  for (std::size_t j = inputs.size(); j-- > 0;) {
    const std::int64_t begin = 3 * whole(inputs[j]);
    auto channels = one.input.slice(1, begin, begin + 3);
    const auto moved = mean.slice(0, begin, begin + 3) + offsets.select(1, whole(j));
    channels.copy_(
        torch::where(one.valid.slice(1, whole(j), whole(j) + 1).gt(0.5), moved, channels));
  }
}

/// Draws random crops, each a function of seed, step and number, so that any process can draw any
/// part.
DenoiseTask::Batch DenoiseTask::draw(std::uint64_t seed, std::uint64_t step,
                                     const BatchPart& part) const {
  const RandomStream random(seed, step);
  std::vector<torch::Tensor> input, base, truth, valid;
  for (std::int64_t k = part.begin; k < part.begin + part.count; ++k) {
    const auto at = static_cast<std::uint64_t>(k) * lanes_per_example;
    const auto below = [&](std::uint64_t lane, std::size_t n) {
      const double value = random.uniform(at, lane) * static_cast<double>(n);
      return std::min(static_cast<std::size_t>(value), n - 1);
    };
    const auto& variants = examples_[below(0, examples_.size())];
    const Example& one = variants[below(1, variants.size())];
    const std::int64_t frames = one.input.size(0);
    // If a stretch is shorter than the crop, all of it is used; its repeated rows get the weight 0
    // below.
    const auto most = static_cast<std::size_t>(std::max<std::int64_t>(frames - training_.crop, 0));
    const std::int64_t begin = whole(below(2, most + 1));
    input.push_back(rows(one.input, begin, training_.crop));
    base.push_back(rows(one.base, begin, training_.crop));
    truth.push_back(rows(one.truth, begin, training_.crop));
    auto weights = rows(one.valid, begin, training_.crop).clone();
    if (frames - begin < training_.crop) weights.slice(0, frames - begin).zero_();
    valid.push_back(weights);
  }
  const auto joined = [&](const std::vector<torch::Tensor>& all) {
    return torch::stack(all).to(device_);
  };
  return {joined(input), joined(base), joined(truth), joined(valid)};
}

torch::Tensor DenoiseTask::answers(const TorchNetwork& network, const torch::Tensor& input,
                                   const torch::Tensor& base, bool training) const {
  // The arithmetic is that of Denoiser::answer_of(), so that training and use agree.
  const auto out = network.forward((input - input_mean_) / input_scale_, training);
  const auto positions = out.slice(2, 0, whole(layout_.answers())).reshape(base.sizes());
  return base + answer_mean_ + positions * training_.answer_scale;
}

torch::Tensor DenoiseTask::weigh(const Batch& batch, const BatchPart& part,
                                 const torch::Tensor& answer, const torch::Tensor& spread) const {
  const DenoiseLoss& weights = training_.loss;
  const auto error = (answer - batch.truth) * centimetres;
  const auto valid = batch.valid * joint_weights_;
  const auto mean_of = [&](const torch::Tensor& values, const torch::Tensor& by) {
    return weighted_mean(values, by, share());
  };
  auto loss = weights.distance * mean_of(lengths_of(error), valid);
  if (weights.square > 0.0) {
    // The division by 100 converts cm^2 to dm^2, the unit of DenoiseLoss::square.
    loss = loss + weights.square * mean_of(error.pow(2).mean(-1), valid) / 100.0;
  }
  const auto n = batch.valid.size(1);
  // A second difference counts only if all three of its frames are valid.
  const auto valid3 = joint_weights_ * batch.valid.slice(1, 2, n) * batch.valid.slice(1, 1, n - 1) *
                      batch.valid.slice(1, 0, n - 2);
  if (weights.acceleration > 0.0) {
    loss = loss + weights.acceleration * mean_of(lengths_of(second_differences(error)), valid3);
  }
  if (weights.smooth > 0.0) {
    loss = loss + weights.smooth * part.mean(lengths_of(second_differences(answer * centimetres)));
  }
  if (weights.bone > 0.0) {
    const auto bones = [&](const torch::Tensor& x) {
      return lengths_of((x.index_select(2, bone_ends_) - x.index_select(2, bone_begins_)) *
                        centimetres);
    };
    const auto both =
        batch.valid.index_select(2, bone_ends_) * batch.valid.index_select(2, bone_begins_);
    loss = loss +
           weights.bone * mean_of((bones(answer) - bones(batch.truth)).abs(), both * bone_weights_);
  }
  if (spread.defined()) {
    // The spread (cm) is the same for three axes. No gradient flows through it into the error. With
    // a normal distribution, a joint that the Kinect puts a metre off would outweigh all others.
    const auto square = error.detach().pow(2).sum(-1) * torch::exp(-2.0 * spread);
    const auto likelihood =
        3.0 * spread + 0.5 * (student_freedom + 3.0) * torch::log1p(square / student_freedom);
    loss = loss + weights.spread * mean_of(likelihood, valid);
  }
  if (features_ && weights.hidden > 0.0) {
    loss = loss +
           weights.hidden *
               part.mean((features_(answer.flatten(2)) - features_(batch.truth.flatten(2))).pow(2));
  }
  return loss;
}

torch::Tensor DenoiseTask::loss(const TorchNetwork& network, std::uint64_t seed,
                                std::uint64_t step) {
  const BatchPart part = share().part(training_.batch);
  const Batch batch = draw(seed, step, part);
  const auto out = network.forward((batch.input - input_mean_) / input_scale_, part);
  const std::int64_t numbers = whole(layout_.answers());
  const auto answer = batch.base + answer_mean_ +
                      out.slice(2, 0, numbers).reshape(batch.base.sizes()) * training_.answer_scale;
  const auto spread = training_.states_spread ? out.slice(2, numbers) : torch::Tensor();
  return weigh(batch, part, answer, spread);
}

torch::Tensor DenoiseTask::first_answer() const {
  const auto zeros = torch::zeros({whole(layout_.answers())});
  if (!training_.states_spread) return zeros;
  const auto mean = answer_mean_.cpu();
  auto squares = torch::zeros({whole(layout_.outputs.size())}), count = torch::zeros_like(squares);
  for (const auto& variants : examples_) {
    for (const Example& one : variants) {
      const auto error = (one.truth - one.base - mean) * centimetres;
      squares += (error.pow(2).sum(-1) * one.valid).sum(0);
      count += one.valid.sum(0);
    }
  }
  const auto of_an_axis = squares / (3.0 * count.clamp_min(1.0));
  return torch::cat({zeros, 0.5 * torch::log(of_an_axis.clamp_min(1e-4))});
}

// Only the positions are used as input, and only frames in which all joints of the truth are valid.
// Targets are in the unit of the network's output.
LinearAnswer DenoiseTask::linear_answer() const {
  const std::int64_t positions = 3 * whole(layout_.inputs.size()),
                     joints = whole(layout_.outputs.size());
  const auto mean = input_mean_.cpu(), scale = input_scale_.cpu(), offset = answer_mean_.cpu();
  LinearFit fit(positions, whole(layout_.answers()), linear_kernel);
  for (const auto& variants : examples_) {
    for (const Example& one : variants) {
      const auto target = (one.truth - one.base - offset).flatten(1) / training_.answer_scale;
      fit.add(((one.input - mean) / scale).slice(1, 0, positions), target,
              one.valid.gt(0.5).all(1));
    }
  }
  LinearAnswer out = fit.solved(linear_penalty);
  if (!training_.states_spread) return out;
  const auto of_an_axis = out.left.reshape({joints, 3}).mean(1).clamp_min(1e-6).sqrt();
  out.weight = torch::cat({out.weight, torch::zeros({joints, positions, linear_kernel})});
  out.bias = torch::cat({out.bias, torch::log(of_an_axis * training_.answer_scale * centimetres)});
  return out;
}

double DenoiseTask::spread_factor(const TorchNetwork& network) const {
  if (!training_.states_spread) return 1.0;
  torch::NoGradGuard guard;
  std::vector<torch::Tensor> ratios;
  for (const auto& variants : examples_) {
    // The pair itself is used, without its mirror image.
    const Example& one = variants.front();
    const auto input = one.input.unsqueeze(0).to(device_), base = one.base.unsqueeze(0).to(device_);
    const auto out = network.forward((input - input_mean_) / input_scale_, false);
    const auto spread = torch::exp(out.slice(2, whole(layout_.answers())));  // cm
    const auto error = answers(network, input, base, false) - one.truth.unsqueeze(0).to(device_);
    const auto ratio = lengths_of(error * centimetres) / spread;
    ratios.push_back(ratio.masked_select(one.valid.unsqueeze(0).to(device_).gt(0.5)).cpu());
  }
  const auto sorted = std::get<0>(torch::cat(ratios).sort());
  if (sorted.size(0) == 0) return 1.0;
  return sorted[sorted.size(0) * 9 / 10].item<double>() / radius_90;
}

/// The mean error of position plus half the mean error of the second differences, cm, over the
/// validation pairs.
std::optional<double> DenoiseTask::judge(const TorchNetwork& network) {
  if (judged_.empty()) return std::nullopt;
  torch::NoGradGuard guard;
  double distance = 0.0, acceleration = 0.0;
  for (const Example& one : judged_) {
    const auto batch = [&](const torch::Tensor& x) { return x.unsqueeze(0).to(device_); };
    const auto valid = batch(one.valid * joint_weights_.cpu());
    const auto error =
        (answers(network, batch(one.input), batch(one.base), false) - batch(one.truth)) *
        centimetres;
    const auto n = valid.size(1);
    distance += weighted_mean(lengths_of(error), valid).item<double>();
    const auto valid3 =
        valid.slice(1, 2, n) * valid.slice(1, 1, n - 1).gt(0.0) * valid.slice(1, 0, n - 2).gt(0.0);
    acceleration += weighted_mean(lengths_of(second_differences(error)), valid3).item<double>();
  }
  return (distance + 0.5 * acceleration) / static_cast<double>(judged_.size());
}

}  // namespace kinalign
