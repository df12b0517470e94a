// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/torch_network.h"

#include "kinalign/learn/tensors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace kinalign {

namespace {

using Layers = std::vector<Layer>;
using Tensors = std::map<std::string, torch::Tensor>;

std::string path_below(const std::string& path, std::size_t i) {
  return path.empty() ? std::to_string(i) : path + "." + std::to_string(i);
}

torch::Tensor uniform(std::vector<std::int64_t> shape, double bound) {
  return torch::empty(shape).uniform_(-bound, bound);
}

/// Makes the tensors of layers; returns the number of output channels. The order of the layers
/// decides which random numbers each tensor gets, so another order would give other weights.
class Maker {
 public:
  explicit Maker(Tensors& tensors) : tensors_(tensors) {}

  std::size_t make(const Layers& layers, const std::string& path, std::size_t channels) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
      channels = make(layers[i], path_below(path, i), channels);
    }
    return channels;
  }

 private:
  /// Makes the tensors of a layer with `in` channels; gives the number of its output channels.
  std::size_t make(const Layer& layer, const std::string& path, std::size_t in) {
    switch (layer.kind) {
      case LayerKind::linear:
        return make_linear(layer, path, in);
      case LayerKind::conv:
        return make_conv(layer, path, in);
      case LayerKind::lstm:
        return make_recurrent(layer, path, in, 4);
      case LayerKind::gru:
        return make_recurrent(layer, path, in, 3);
      case LayerKind::layer_norm:
        tensors_[path + ".weight"] = torch::ones({whole(in)});
        tensors_[path + ".bias"] = torch::zeros({whole(in)});
        return in;
      case LayerKind::slice:
        return layer.out;
      case LayerKind::sum:
      case LayerKind::product:
      case LayerKind::concat:
        return make_branches(layer, path, in);
      case LayerKind::along_time:
        make_branches(layer, path, layer.window);
        return in;
      default:
        return in;
    }
  }

  std::size_t make_linear(const Layer& layer, const std::string& path, std::size_t in) {
    const double bound = 1.0 / std::sqrt(static_cast<double>(in));
    tensors_[path + ".weight"] = uniform({whole(layer.out), whole(in)}, bound);
    tensors_[path + ".bias"] = uniform({whole(layer.out)}, bound);
    return layer.out;
  }

  std::size_t make_conv(const Layer& layer, const std::string& path, std::size_t in) {
    const double bound = 1.0 / std::sqrt(static_cast<double>(in * layer.kernel));
    tensors_[path + ".weight"] = uniform({whole(layer.out), whole(in), whole(layer.kernel)}, bound);
    tensors_[path + ".bias"] = uniform({whole(layer.out)}, bound);
    return layer.out;
  }

  std::size_t make_recurrent(const Layer& layer, const std::string& path, std::size_t in,
                             std::int64_t gates) {
    const double bound = 1.0 / std::sqrt(static_cast<double>(layer.out));
    const std::int64_t units = whole(layer.out);
    for (const char* way : {"", "_reverse"}) {
      if (*way != 0 && !layer.bidirectional) break;
      tensors_[path + ".weight_ih_l0" + way] = uniform({gates * units, whole(in)}, bound);
      std::vector<torch::Tensor> squares;
      for (std::int64_t g = 0; g < gates; ++g) {
        squares.push_back(torch::nn::init::orthogonal_(torch::empty({units, units})));
      }
      tensors_[path + ".weight_hh_l0" + way] = torch::cat(squares);
      auto bias = uniform({gates * units}, bound);
      // The gates of an LSTM are input, forget, cell, output. A forget gate that is open at first
      // lets gradients reach far back in time.
      if (gates == 4) bias.slice(0, units, 2 * units).fill_(1.0);
      tensors_[path + ".bias_ih_l0" + way] = bias;
      // PyTorch has two biases for each gate. One of them is enough at the start.
      tensors_[path + ".bias_hh_l0" + way] = torch::zeros({gates * units});
    }
    return layer.bidirectional ? 2 * layer.out : layer.out;
  }

  std::size_t make_branches(const Layer& layer, const std::string& path, std::size_t in) {
    std::size_t all = 0, last = in;
    for (std::size_t b = 0; b < layer.branches.size(); ++b) {
      last = make(layer.branches[b], path_below(path, b), in);
      all += last;
    }
    return layer.kind == LayerKind::concat ? all : last;
  }

  Tensors& tensors_;
};

/// Runs layers on values [B,T,C].
/// One object serves one pass. `part` decides whether dropout and the random unpool are active.
class Runner {
 public:
  /// `part`: the part of the batch in training; absent outside training.
  Runner(const Tensors& tensors, std::optional<BatchPart> part) : tensors_(tensors), part_(part) {}

  torch::Tensor run(const Layers& layers, const std::string& path, torch::Tensor x) const {
    // An unpool restores the length before the matching max_pool. The last max_pool is restored
    // first.
    std::vector<std::int64_t> lengths;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const Layer& layer = layers[i];
      if (layer.kind == LayerKind::max_pool) lengths.push_back(x.size(1));
      if (layer.kind == LayerKind::unpool) {
        x = unpool(x, lengths.back());
        lengths.pop_back();
      } else {
        x = run(layer, path_below(path, i), x);
      }
    }
    return x;
  }

 private:
  torch::Tensor run(const Layer& layer, const std::string& path, const torch::Tensor& x) const {
    switch (layer.kind) {
      case LayerKind::linear:
        return torch::linear(x, at(path + ".weight"), at(path + ".bias"));
      case LayerKind::conv:
        return conv(layer, path, x);
      case LayerKind::lstm: {
        const auto zero = state(layer, x);
        return std::get<0>(torch::lstm(x, {zero, zero}, recurrent(layer, path), true, 1, 0.0,
                                       has_gradients(), layer.bidirectional, true));
      }
      case LayerKind::gru:
        return std::get<0>(torch::gru(x, state(layer, x), recurrent(layer, path), true, 1, 0.0,
                                      has_gradients(), layer.bidirectional, true));
      case LayerKind::layer_norm:
        return torch::layer_norm(x, {x.size(2)}, at(path + ".weight"), at(path + ".bias"), 1e-5);
      case LayerKind::relu:
        return torch::relu(x);
      case LayerKind::leaky_relu:
        return torch::leaky_relu(x, layer.slope);
      case LayerKind::gelu:
        return torch::gelu(x);
      case LayerKind::tanh:
        return torch::tanh(x);
      case LayerKind::sigmoid:
        return torch::sigmoid(x);
      case LayerKind::dropout:
        return dropout(x, layer.rate);
      case LayerKind::slice:
        return x.slice(2, whole(layer.begin), whole(layer.begin + layer.out));
      case LayerKind::max_pool:
        return torch::max_pool1d(x.transpose(1, 2), 2, 2, 0, 1, true).transpose(1, 2);
      case LayerKind::unpool:
        return x;  // done in run() above, which knows the length
      case LayerKind::sum:
      case LayerKind::product:
      case LayerKind::concat:
        return branches(layer, path, x);
      case LayerKind::along_time:
        return along_time(layer, path, x);
    }
    return x;
  }

  /// Padding is done by hand, because a causal convolution needs all of it before the first frame.
  torch::Tensor conv(const Layer& layer, const std::string& path, const torch::Tensor& x) const {
    const std::int64_t reach = whole((layer.kernel - 1) * layer.dilation);
    const std::int64_t before = layer.causal ? reach : reach / 2;
    const auto padded = torch::constant_pad_nd(x.transpose(1, 2), {before, reach - before});
    const std::vector<std::int64_t> step{1}, padding{0}, dilation{whole(layer.dilation)};
    return torch::conv1d(padded, at(path + ".weight"), at(path + ".bias"), step,
                         torch::IntArrayRef(padding), dilation)
        .transpose(1, 2);
  }

  /// Random numbers in the shape of `x`: `draw` fills the numbers of the whole batch, and the
  /// part's rows are returned. The order is that of the indices, independent of the memory layout
  /// of `x`. Within along_time an example has several rows.
  torch::Tensor drawn_like(const torch::Tensor& x,
                           const std::function<void(torch::Tensor&)>& draw) const {
    const std::int64_t rows = x.size(0) / std::max<std::int64_t>(part_->count, 1);
    auto all = torch::empty({part_->whole * rows, x.size(1), x.size(2)}, x.options());
    draw(all);
    return all.slice(0, part_->begin * rows, (part_->begin + part_->count) * rows);
  }

  torch::Tensor dropout(const torch::Tensor& x, double rate) const {
    if (!part_) return x;
    const auto kept =
        drawn_like(x, [&](torch::Tensor& all) { all.bernoulli_(1.0 - rate).div_(1.0 - rate); });
    return x * kept;
  }

  /// In training each value goes to a random one of its two frames. In use half of it goes to both
  /// frames.
  torch::Tensor unpool(const torch::Tensor& x, std::int64_t length) const {
    const auto twice = x.repeat_interleave(2, 1).slice(1, 0, length);
    if (!part_) return twice * 0.5;
    const auto first =
        drawn_like(x, [](torch::Tensor& all) { all.uniform_(); }).lt(0.5).to(x.dtype());
    const auto chosen = torch::stack({first, 1.0 - first}, 2)
                            .reshape({x.size(0), 2 * x.size(1), x.size(2)})
                            .slice(1, 0, length);
    return twice * chosen;
  }

  torch::Tensor branches(const Layer& layer, const std::string& path,
                         const torch::Tensor& x) const {
    std::vector<torch::Tensor> all;
    for (std::size_t b = 0; b < layer.branches.size(); ++b) {
      all.push_back(run(layer.branches[b], path_below(path, b), x));
    }
    if (layer.kind == LayerKind::concat) return torch::cat(all, 2);
    torch::Tensor out = all.front();
    for (std::size_t b = 1; b < all.size(); ++b) {
      out = layer.kind == LayerKind::sum ? out + all[b] : out * all[b];
    }
    return out;
  }

  /// Applies the branch to each channel as a separate sequence. Overlapping windows are averaged.
  torch::Tensor along_time(const Layer& layer, const std::string& path,
                           const torch::Tensor& x) const {
    const std::int64_t frames = x.size(1), window = whole(layer.window);
    if (frames == 0) return x;
    // A sequence shorter than the window is padded with its last frame, as in infer.
    const std::int64_t lacking = std::max<std::int64_t>(window - frames, 0);
    const auto last = x.slice(1, frames - 1).expand({x.size(0), lacking, x.size(2)});
    const auto sequences = torch::cat({x, last}, 1).transpose(1, 2).flatten(0, 1);
    const auto results =
        run(layer.branches.front(), path_below(path, 0), sequences.unfold(1, window, 1));
    // col2im adds overlapping windows; dividing by the same sum of ones gives their mean.
    const auto overlaid = [&](const torch::Tensor& windows) {
      return torch::col2im(windows.transpose(1, 2), {frames + lacking, 1}, {window, 1}, {1, 1},
                           {0, 0}, {1, 1});
    };
    const auto mean = overlaid(results) / overlaid(torch::ones_like(results));
    return mean.reshape({x.size(0), x.size(2), -1}).slice(2, 0, frames).transpose(1, 2);
  }

  /// cuDNN can't compute gradients of recurrent layers from its inference form. Its training form
  /// differs only by the dropout between layers, and each of our recurrent layers is a single one.
  static bool has_gradients() { return torch::GradMode::is_enabled(); }

  static torch::Tensor state(const Layer& layer, const torch::Tensor& x) {
    return torch::zeros({layer.bidirectional ? 2 : 1, x.size(0), whole(layer.out)}, x.options());
  }

  std::vector<torch::Tensor> recurrent(const Layer& layer, const std::string& path) const {
    std::vector<torch::Tensor> out;
    for (const char* way : {"", "_reverse"}) {
      if (*way != 0 && !layer.bidirectional) break;
      for (const char* name : {".weight_ih_l0", ".weight_hh_l0", ".bias_ih_l0", ".bias_hh_l0"}) {
        out.push_back(at(path + name + way));
      }
    }
    return out;
  }

  const torch::Tensor& at(const std::string& name) const { return tensors_.at(name); }

  const Tensors& tensors_;
  std::optional<BatchPart> part_;
};

/// The path of the last layer with weights; empty if there is none.
std::string last_weighted(const Layers& layers, const std::string& path) {
  for (std::size_t i = layers.size(); i-- > 0;) {
    const LayerKind kind = layers[i].kind;
    if (kind == LayerKind::linear || kind == LayerKind::conv) return path_below(path, i);
    for (std::size_t b = layers[i].branches.size(); b-- > 0;) {
      const std::string found =
          last_weighted(layers[i].branches[b], path_below(path_below(path, i), b));
      if (!found.empty()) return found;
    }
  }
  return "";
}

}  // namespace

TorchNetwork::TorchNetwork(Architecture architecture) : architecture_(std::move(architecture)) {
  torch::NoGradGuard guard;
  Maker(tensors_).make(architecture_.layers, "", architecture_.inputs);
  for (auto& [name, tensor] : tensors_) tensor.set_requires_grad(true);
}

torch::Tensor TorchNetwork::forward(const torch::Tensor& input, bool training) const {
  const BatchPart all{0, input.size(0), input.size(0)};
  return Runner(tensors_, training ? std::optional(all) : std::nullopt)
      .run(architecture_.layers, "", input);
}

torch::Tensor TorchNetwork::forward(const torch::Tensor& input, const BatchPart& part) const {
  return Runner(tensors_, part).run(architecture_.layers, "", input);
}

torch::Tensor run_layers(const std::vector<Layer>& layers,
                         const std::map<std::string, torch::Tensor>& tensors,
                         const torch::Tensor& input) {
  return Runner(tensors, std::nullopt).run(layers, "", input);
}

void TorchNetwork::zero_last(const torch::Tensor& bias) {
  torch::NoGradGuard guard;
  const std::string path = last_weighted(architecture_.layers, "");
  if (path.empty()) return;
  tensors_.at(path + ".weight").zero_();
  if (bias.defined()) {
    tensors_.at(path + ".bias").copy_(bias);
  } else {
    tensors_.at(path + ".bias").zero_();
  }
}

void TorchNetwork::to(torch::Device device) {
  torch::NoGradGuard guard;
  for (auto& [name, tensor] : tensors_) {
    // A moved tensor must be a leaf of the graph, else it would get no gradient.
    tensor = tensor.detach().to(device).set_requires_grad(true);
  }
}

}  // namespace kinalign
