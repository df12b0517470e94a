// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/window_network.h"

#include "kinalign/infer/flush_to_zero.h"
#include "kinalign/infer/prepared.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace kinalign {

namespace {

/// Rows of a layer's result, or of the window itself.
struct Rows {
  const float* data = nullptr;
  std::size_t stride = 0;
  std::size_t changed = 0;  // rows from this one on are new

  const float* at(std::size_t row) const { return data + row * stride; }
};

/// One layer's results for the window. The first `computed` rows are valid for the present window.
/// If frames leave the window, `forget_rows` moves the rows with it.
struct LayerWindow {
  const PreparedLayer* layer = nullptr;
  std::size_t before = 0, after = 0;  // number of frames before and after that a result depends on
  std::size_t channels = 0;
  Values out;                // [rows, channels] the results
  std::size_t computed = 0;  // number of valid rows of `out`
  std::vector<std::vector<LayerWindow>> branches;
  std::vector<Rows> found;  // the branches' results in the current run
};

// The number of later frames that a list of layers needs, summed over its layers.
std::size_t after_all(const std::vector<LayerWindow>& layers) {
  std::size_t out = 0;
  for (const LayerWindow& layer : layers) out += layer.after;
  return out;
}

/// Room for each layer's rows, and the frames before and after that each layer needs.
std::vector<LayerWindow> windows_of(const std::vector<PreparedLayer>& layers) {
  std::vector<LayerWindow> out;
  for (const PreparedLayer& layer : layers) {
    LayerWindow& one = out.emplace_back();
    one.layer = &layer;
    one.channels = layer.outputs;
    if (layer.layer.kind == LayerKind::conv) {
      const std::size_t reach = (layer.layer.kernel - 1) * layer.layer.dilation;
      one.before = layer.layer.causal ? reach : reach / 2;
      one.after = reach - one.before;
    }
    for (const auto& branch : layer.branches) {
      one.branches.push_back(windows_of(branch));
      one.after = std::max(one.after, after_all(one.branches.back()));
    }
    one.found.resize(one.branches.size());
  }
  return out;
}

// Results that used forgotten frames stay valid, since the frames before a row do not change.
void forget_rows(std::vector<LayerWindow>& layers, std::size_t count) {
  for (LayerWindow& layer : layers) {
    const std::size_t gone = std::min(count, layer.computed);
    std::copy(layer.out.begin() + static_cast<std::ptrdiff_t>(gone * layer.channels),
              layer.out.begin() + static_cast<std::ptrdiff_t>(layer.computed * layer.channels),
              layer.out.begin());
    layer.computed -= gone;
    for (auto& branch : layer.branches) forget_rows(branch, count);
  }
}

/// One run over a window of `frames` rows. Layers are visited in order. Each layer computes its
/// rows from the first one that may have changed, and returns that row's index to the next layer.
class WindowRun {
 public:
  WindowRun(const Kernels& kernels, std::size_t frames, Values& scratch)
      : kernels_(kernels), frames_(frames), scratch_(scratch) {}

  /// Returns the rows before `end` of the last layer's result. Each earlier layer computes as many
  /// more rows as the layers after it need.
  Rows list(std::vector<LayerWindow>& layers, Rows in, std::size_t end) {
    std::size_t after = after_all(layers);
    for (LayerWindow& layer : layers) {
      after -= layer.after;
      in = one(layer, in, std::min(end + after, frames_));
    }
    return in;
  }

 private:
  /// Computes the rows of one layer that have changed or are not yet valid.
  Rows one(LayerWindow& layer, Rows in, std::size_t end) {
    const LayerKind kind = layer.layer->layer.kind;
    if (kind == LayerKind::dropout) return in;
    if (kind == LayerKind::slice) {
      return {in.data + layer.layer->layer.begin, in.stride, in.changed};
    }
    // A changed input row changes the results up to `after` rows before it.
    std::size_t from = std::min(layer.computed, in.changed - std::min(in.changed, layer.after));
    for (std::size_t b = 0; b < layer.branches.size(); ++b) {
      layer.found[b] = list(layer.branches[b], in, end);
      from = std::min(from, layer.found[b].changed);
    }
    if (layer.out.size() < end * layer.channels) layer.out.resize(end * layer.channels);
    if (from < end) compute(layer, in, from, end);
    // Rows after `end` are not computed now, so they must not count as valid.
    layer.computed = std::max(from, end);
    return {layer.out.data(), layer.channels, from};
  }

  /// Computes the layer's rows from `from` to `end`.
  void compute(LayerWindow& layer, const Rows& in, std::size_t from, std::size_t end) {
    const PreparedLayer& prepared = *layer.layer;
    switch (prepared.layer.kind) {
      case LayerKind::linear:
      case LayerKind::conv:
        return multiply(layer, in, from, end);
      case LayerKind::sum:
      case LayerKind::product:
      case LayerKind::concat:
        return join(layer, from, end);
      default:
        break;
    }
    for (std::size_t t = from; t < end; ++t) {
      float* const out = &layer.out[t * layer.channels];
      if (prepared.layer.kind == LayerKind::layer_norm) {
        kernels_.layer_norm(in.at(t), out, prepared.norm_weight.data(), prepared.norm_bias.data(),
                            layer.channels);
      } else {
        std::copy_n(in.at(t), layer.channels, out);
        apply_activation(kernels_, prepared.layer, out, layer.channels);
      }
    }
  }

  /// Computes rows `from` ... `end` - 1 of a linear or conv layer. Frames outside the window are
  /// zeros. The input rows are copied into one array with zeros around them, so that the kernel
  /// gets the same numbers as in Network::run.
  void multiply(LayerWindow& layer, const Rows& in, std::size_t from, std::size_t end) {
    const std::size_t channels = layer.layer->inputs;
    const std::size_t rows = end - from + layer.before + layer.after;
    scratch_.assign(rows * channels, 0.0F);
    for (std::size_t i = 0; i < rows; ++i) {
      const std::size_t row = from + i;  // row of the window, plus `before`
      if (row < layer.before || row - layer.before >= frames_) continue;
      std::copy_n(in.at(row - layer.before), channels, &scratch_[i * channels]);
    }
    Product product = layer.layer->weights.product();
    product.in = scratch_.data();
    product.in_stride = channels;
    product.tap_stride = layer.layer->layer.dilation * channels;
    product.out = &layer.out[from * layer.channels];
    product.out_stride = layer.channels;
    product.frames = end - from;
    kernels_.multiply(product);
  }

  /// Joins, adds or multiplies the branches' rows from `from` to `end`.
  void join(LayerWindow& layer, std::size_t from, std::size_t end) {
    const LayerKind kind = layer.layer->layer.kind;
    for (std::size_t t = from; t < end; ++t) {
      float* out = &layer.out[t * layer.channels];
      for (std::size_t b = 0; b < layer.found.size(); ++b) {
        const auto& below = layer.branches[b];
        const std::size_t channels = below.empty() ? layer.layer->inputs : below.back().channels;
        if (kind == LayerKind::concat) {
          std::copy_n(layer.found[b].at(t), channels, out);
          out += channels;
        } else if (b == 0) {
          std::copy_n(layer.found[b].at(t), channels, out);
        } else if (kind == LayerKind::sum) {
          kernels_.add(out, layer.found[b].at(t), channels);
        } else {
          kernels_.scale_by(out, layer.found[b].at(t), channels);
        }
      }
    }
  }

  const Kernels& kernels_;
  std::size_t frames_;
  Values& scratch_;
};

/// Whether each output depends on a bounded number of frames.
bool are_bounded(const std::vector<Layer>& layers) {
  return std::all_of(layers.begin(), layers.end(), [](const Layer& layer) {
    switch (layer.kind) {
      case LayerKind::lstm:
      case LayerKind::gru:
      case LayerKind::max_pool:
      case LayerKind::unpool:
      case LayerKind::along_time:
        return false;
      default:
        return std::all_of(layer.branches.begin(), layer.branches.end(),
                           [](const auto& branch) { return are_bounded(branch); });
    }
  });
}

}  // namespace

/// The data that are kept between runs: the number of frames, and the results of each layer.
struct WindowNetwork::State {
  const Network* network = nullptr;
  std::size_t frames = 0;           // frames of the previous run that are still in the window
  std::vector<LayerWindow> layers;  // empty: the network runs over the whole window each time
  Values scratch;
  Workspace workspace;
  std::vector<float> all;
};

WindowNetwork::WindowNetwork(const Network& network) : state_(std::make_unique<State>()) {
  state_->network = &network;
  if (are_bounded(network.architecture().layers)) {
    state_->layers = windows_of(network.prepared_->layers);
  }
}
WindowNetwork::WindowNetwork(WindowNetwork&&) noexcept = default;
WindowNetwork& WindowNetwork::operator=(WindowNetwork&&) noexcept = default;
WindowNetwork::~WindowNetwork() = default;

void WindowNetwork::forget(std::size_t count) {
  forget_rows(state_->layers, count);
  state_->frames -= std::min(count, state_->frames);
}

std::span<const float> WindowNetwork::run(std::span<const float> in, std::size_t frames,
                                          std::size_t changed, std::size_t end) {
  const Network& network = *state_->network;
  assert(in.size() == frames * network.inputs() && end > 0 && end <= frames);
  // A network without layers is run here, too; it costs nothing.
  if (state_->layers.empty()) {
    network.run(in, frames, state_->workspace, state_->all);
    return std::span<const float>(state_->all).first(end * network.outputs());
  }
  // Rows beyond the window of the previous run are new, whatever `changed` says.
  changed = std::min(changed, state_->frames);
  state_->frames = frames;
  const FlushToZero flush;
  WindowRun run(*network.prepared_->kernels, frames, state_->scratch);
  const Rows out = run.list(state_->layers, {in.data(), network.inputs(), changed}, end);
  return {out.data, end * network.outputs()};
}

}  // namespace kinalign
