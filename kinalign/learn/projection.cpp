// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/projection.h"

#include "kinalign/evaluate/statistics.h"
#include "kinalign/infer/shapes.h"
#include "kinalign/learn/tensors.h"
#include "kinalign/learn/torch_network.h"
#include "kinalign/models/bones.h"
#include "kinalign/models/joint_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

namespace kinalign {

namespace {

// With these limits 86 % of the true contacts in UI-PRMD are found, and 99 % of the found ones are
// true.
constexpr double fastest_m_s = 0.3, highest_m = 0.1, usual_lowest = 0.05;
constexpr std::ptrdiff_t least_standing = 4;  // frames
constexpr float cm_per_m = 100.0F;
constexpr std::array<std::string_view, 4> foot_joints{"AnkleLeft", "FootLeft", "AnkleRight",
                                                      "FootRight"};

std::size_t unpool_of(const std::vector<Layer>& layers) {
  const auto found = std::find_if(layers.begin(), layers.end(), [](const Layer& layer) {
    return layer.kind == LayerKind::unpool;
  });
  return static_cast<std::size_t>(found - layers.begin());
}

/// The body's frames as tensors: root [T,1,3] m, cosine and sine [T,1].
struct FrameTensors {
  torch::Tensor root, cosine, sine;
};

FrameTensors tensors_of(const std::vector<BodyFrame>& frames) {
  std::vector<float> root, cosine, sine;
  for (const BodyFrame& frame : frames) {
    root.insert(root.end(), frame.root.begin(), frame.root.end());
    cosine.push_back(frame.cosine);
    sine.push_back(frame.sine);
  }
  const std::int64_t n = whole(frames.size());
  return {to_torch(root, {n, 1, 3}), to_torch(cosine, {n, 1}), to_torch(sine, {n, 1})};
}

/// Moves positions [T,J,3] m from the body's frame to the world's space.
torch::Tensor in_world(const FrameTensors& frames, const torch::Tensor& body) {
  const auto x = body.select(2, 0), z = body.select(2, 2);
  const auto turned = torch::stack(
      {frames.cosine * x - frames.sine * z, body.select(2, 1), frames.cosine * z + frames.sine * x},
      2);
  return turned + frames.root;
}

/// The mean of `values` where `weights` is 1; 0 if no weight is 1.
torch::Tensor mean_where(const torch::Tensor& values, const torch::Tensor& weights) {
  return (values * weights).sum() / weights.sum().clamp_min(1.0);
}

/// The mean; 0 if there are no values.
torch::Tensor mean_of(const torch::Tensor& values) {
  return values.sum() / std::max<std::int64_t>(values.numel(), 1);
}

/// A model's network in two halves: from the input to its code, and from the code to the motion.
/// The halves meet at the unpool. Adam changes the pooled code before it.
class Autoencoder {
 public:
  Autoencoder(const DenoiseModel& model, const DenoiseFeatures& features)
      : scale_(model.answer_scale), frames_(whole(features.frames.size())) {
    const auto& layers = model.architecture.layers;
    const std::size_t middle = unpool_of(layers);
    encoder_.assign(layers.begin(), layers.begin() + static_cast<std::ptrdiff_t>(middle));
    // The decoder keeps the numbers of the layers, because tensors are named by them. The layers of
    // the encoder become the identity there.
    decoder_ = layers;
    for (std::size_t i = 0; i <= middle; ++i) decoder_[i] = {.kind = LayerKind::dropout};
    for (const Parameter& parameter : parameters(model.architecture)) {
      tensors_[parameter.name] = to_torch(model.tensors.at("net." + parameter.name));
    }
    const auto row = [](const std::vector<float>& values) {
      return to_torch(values, {whole(values.size())});
    };
    const auto input = to_torch(features.input, {1, frames_, whole(model.layout.channels())});
    input_ = (input - row(model.input_mean)) / row(model.input_scale);
    const std::int64_t joints = whole(model.layout.outputs.size());
    base_ =
        to_torch(features.base, {frames_, joints, 3}) + row(model.answer_mean).reshape({joints, 3});
  }

  torch::Tensor code() const { return run_layers(encoder_, tensors_, input_); }

  /// The decoded motion [T,Jout,3] m in the body's frame.
  torch::Tensor motion(const torch::Tensor& code) const {
    // This is the average unpool of a network in use, not the random one of training.
    const auto unpooled = 0.5 * code.repeat_interleave(2, 1).slice(1, 0, frames_);
    const auto out = run_layers(decoder_, tensors_, unpooled);
    const std::int64_t channels = base_.size(1) * 3;
    return base_ + scale_ * out.slice(2, 0, channels).reshape(base_.sizes());
  }

 private:
  double scale_;
  std::int64_t frames_;
  std::vector<Layer> encoder_, decoder_;
  std::map<std::string, torch::Tensor> tensors_;
  torch::Tensor input_, base_;
};

/// The constraints of a motion. Bone lengths and the root's path come from the model's result,
/// standing feet from the input. Feet are compared in the world, because a foot that stands still
/// moves in the body's frame.
class Constraints {
 public:
  Constraints(const DenoiseLayout& layout, const JointFrames& body, const DenoiseFeatures& features,
              const torch::Tensor& answer)
      : frames_(tensors_of(features.frames)) {
    std::vector<std::int64_t> roots, ends, begins;
    std::vector<float> usual;
    const auto lengths =
        typical_lengths(layout.parents, mirror_partners(layout.outputs), values_of(answer));
    for (std::size_t j = 0; j < layout.outputs.size(); ++j) {
      if (layout.parents[j] < 0) {
        roots.push_back(whole(j));
        continue;
      }
      ends.push_back(whole(j));
      begins.push_back(layout.parents[j]);
      usual.push_back(lengths[j]);
    }
    roots_ = torch::tensor(roots, torch::kInt64);
    ends_ = torch::tensor(ends, torch::kInt64);
    begins_ = torch::tensor(begins, torch::kInt64);
    lengths_ = torch::tensor(usual) * cm_per_m;
    path_ = (answer * cm_per_m).index_select(1, roots_);
    find_standing(layout, body);
  }

  /// The mean squares of the three deviations, cm^2: feet, path, bones.
  std::array<torch::Tensor, 3> squares(const torch::Tensor& motion) const {
    const auto body = motion * cm_per_m;
    const auto feet = in_world(frames_, motion).index_select(1, feet_) * cm_per_m;
    const auto moves = (feet.slice(0, 1) - feet.slice(0, 0, -1)).pow(2).sum(-1);
    const auto bones = (body.index_select(1, ends_) - body.index_select(1, begins_)).pow(2).sum(-1);
    const auto path = (body.index_select(1, roots_) - path_).pow(2).sum(-1);
    return {mean_where(moves, standing_), mean_of(path),
            // The small number keeps the gradient finite for a bone of length 0.
            mean_of(((bones + 1e-4).sqrt() - lengths_).pow(2))};
  }

 private:
  /// Finds standing feet in the input. The motion between two frames counts if the foot stands in
  /// both.
  void find_standing(const DenoiseLayout& layout, const JointFrames& body) {
    JointFrames smoothed = body;
    fill_missing(smoothed, layout.smoothing.causal);
    smooth(layout.smoothing, 3 * body.joints, smoothed.positions);
    const auto inputs = kinect_names(layout.inputs), outputs = kinect_names(layout.outputs);
    std::vector<std::int64_t> places;
    std::vector<torch::Tensor> columns;
    for (const std::string_view name : foot_joints) {
      const auto seen = index_of(inputs, name), answered = index_of(outputs, name);
      if (!seen || !answered) continue;
      std::vector<float> foot;
      for (std::size_t t = 0; t < body.frames(); ++t) {
        const float* at = &smoothed.positions[(t * body.joints + *seen) * 3];
        foot.insert(foot.end(), at, at + 3);
      }
      const auto frames = standing_frames(foot, layout.rate_hz);
      const auto stands = to_torch({frames.begin(), frames.end()}, {whole(frames.size())});
      places.push_back(whole(*answered));
      // One column for each foot joint that both the input and the output have.
      columns.push_back(stands.slice(0, 1) * stands.slice(0, 0, -1));
    }
    feet_ = torch::tensor(places, torch::kInt64);
    standing_ =
        columns.empty() ? torch::zeros({whole(body.frames()) - 1, 0}) : torch::stack(columns, 1);
  }

  FrameTensors frames_;
  torch::Tensor roots_, ends_, begins_, lengths_, path_, feet_;
  torch::Tensor standing_;  // [T-1,F] 1 if foot f stands in both frames
};

ConstraintErrors errors_of(const std::array<torch::Tensor, 3>& squares) {
  const auto root = [&](std::size_t i) { return std::sqrt(squares[i].item<double>()); };
  return {root(0), root(1), root(2)};
}

}  // namespace

std::vector<std::uint8_t> standing_frames(std::span<const float> foot, double rate_hz) {
  const std::size_t frames = foot.size() / 3;
  std::vector<std::uint8_t> out(frames, 0);
  std::vector<double> heights;
  for (std::size_t t = 0; t < frames; ++t) heights.push_back(foot[3 * t + 1]);
  if (frames < 2) return out;
  // A low quantile is used and not the minimum, so that one wrong frame does not lower the floor.
  const double floor_m = quantile(heights, usual_lowest);
  for (std::size_t t = 0; t < frames; ++t) {
    const float* a = &foot[3 * (t == 0 ? 0 : t - 1)];
    const float* b = a + 3;
    const double speed = rate_hz * std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    out[t] = speed < fastest_m_s && heights[t] < floor_m + highest_m ? 1 : 0;
  }
  // Runs of standing frames that are too short do not count.
  for (auto begin = out.begin(); begin != out.end();) {
    const auto end = std::find_if(begin, out.end(), [begin](auto one) { return one != *begin; });
    if (end - begin < least_standing) std::fill(begin, end, 0);
    begin = end;
  }
  return out;
}

bool has_hidden_space(const DenoiseModel& model) {
  const auto& layers = model.architecture.layers;
  const auto unpools = std::count_if(layers.begin(), layers.end(), [](const Layer& layer) {
    return layer.kind == LayerKind::unpool;
  });
  return unpools == 1 && !model.second;
}

Result<Projected> project(const DenoiseModel& model, const JointFrames& body,
                          const ProjectionOptions& options) {
  if (!has_hidden_space(model)) {
    return Failure(Error{"", 0, "a model whose network has a hidden space, such as a cnn model",
                         "a model of " + shown(model.facts.method)});
  }
  const DenoiseFeatures features = denoise_features(model.layout, body);
  const Autoencoder autoencoder(model, features);
  torch::Tensor code = autoencoder.code().detach().clone();
  const auto answer = autoencoder.motion(code).detach();
  Projected out;
  if (body.frames() >= 2) {
    const Constraints constraints(model.layout, body, features, answer);
    out.before = errors_of(constraints.squares(answer));
    code.set_requires_grad(true);
    // The epsilon of 1e-5 is that of the released code.
    torch::optim::Adam adam({code}, torch::optim::AdamOptions(options.rate).eps(1e-5));
    for (std::int64_t step = 0; step < options.steps; ++step) {
      adam.zero_grad();
      const auto squares = constraints.squares(autoencoder.motion(code));
      (options.feet * squares[0] + options.path * squares[1] + options.bones * squares[2])
          .backward();
      adam.step();
    }
    out.after = errors_of(constraints.squares(autoencoder.motion(code).detach()));
  }
  out.answer.positions = values_of(autoencoder.motion(code));
  to_world(features.frames, out.answer.positions);
  return out;
}

}  // namespace kinalign
