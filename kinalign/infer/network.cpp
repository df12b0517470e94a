// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/network.h"

#include "kinalign/infer/flush_to_zero.h"
#include "kinalign/infer/prepare.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace kinalign {

namespace {

/// Values between two layers [T,C]: a block of the workspace, or the caller's input.
/// A sequence with a block owns the block until `drop`. A sequence without a block is the caller's
/// input and must not be changed.
struct Sequence {
  const float* data = nullptr;
  std::size_t frames = 0, channels = 0;
  std::optional<std::size_t> block;

  std::size_t size() const { return frames * channels; }
};

constexpr std::size_t window_block = 256;  // rows of along_time that are processed together

/// One run of the network. The function of each layer owns its input: it returns the input's block
/// to the workspace or passes the block on. Blocks are returned as early as possible, so that later
/// layers of the run use them again.
class Run {
 public:
  Run(const Kernels& kernels, Workspace& workspace) : kernels_(kernels), workspace_(workspace) {}

  Sequence list(const std::vector<PreparedLayer>& layers, Sequence in) {
    for (const PreparedLayer& layer : layers) in = one(layer, in);
    return in;
  }

 private:
  /// Runs one layer on a whole sequence.
  Sequence one(const PreparedLayer& layer, Sequence in) {
    switch (layer.layer.kind) {
      case LayerKind::linear:
      case LayerKind::conv:
        return conv(layer, in);
      case LayerKind::lstm:
      case LayerKind::gru:
        return recurrent(layer, in);
      case LayerKind::layer_norm:
        return layer_norm(layer, in);
      // Dropout acts in training only.
      case LayerKind::dropout:
        return in;
      case LayerKind::slice:
        return slice(layer, in);
      case LayerKind::max_pool:
        return max_pool(in);
      case LayerKind::unpool:
        return unpool(in);
      case LayerKind::sum:
      case LayerKind::product:
      case LayerKind::concat:
        return branches(layer, in);
      case LayerKind::along_time:
        return along_time(layer, in);
      default:
        return activation(layer.layer, in);
    }
  }

  // A sequence in a free block of the workspace.
  Sequence fresh(std::size_t frames, std::size_t channels) {
    const std::size_t block = workspace_.take(frames * channels);
    return {workspace_.values(block), frames, channels, block};
  }

  float* writable(const Sequence& sequence) { return workspace_.values(*sequence.block); }

  void drop(const Sequence& sequence) {
    if (sequence.block) workspace_.give_back(*sequence.block);
  }

  /// Returns the values of `in` in a block that may be changed. The caller's input is copied.
  Sequence owned(Sequence in) {
    if (in.block) return in;
    const Sequence out = fresh(in.frames, in.channels);
    std::copy_n(in.data, in.size(), writable(out));
    return out;
  }

  /// The values with zeros before and after, so that every tap of a convolution has a frame.
  Sequence padded(const Layer& layer, Sequence in) {
    const std::size_t reach = (layer.kernel - 1) * layer.dilation;
    if (reach == 0) return in;
    const std::size_t before = (layer.causal ? reach : reach / 2) * in.channels;
    const Sequence out = fresh(in.frames + reach, in.channels);
    float* const values = writable(out);
    std::fill_n(values, before, 0.0F);
    std::copy_n(in.data, in.size(), values + before);
    std::fill(values + before + in.size(), values + out.size(), 0.0F);
    drop(in);
    return out;
  }

  /// Runs a linear layer or a convolution as one product over all frames.
  /// The padded input makes every frame alike: tap k of frame t is row t + k dilation.
  Sequence conv(const PreparedLayer& layer, Sequence in) {
    const Sequence out = fresh(in.frames, layer.outputs);
    in = padded(layer.layer, in);
    Product product = layer.weights.product();
    product.in = in.data;
    product.in_stride = in.channels;
    product.tap_stride = layer.layer.dilation * in.channels;
    product.out = writable(out);
    product.out_stride = out.channels;
    product.frames = out.frames;
    kernels_.multiply(product);
    drop(in);
    return out;
  }

  /// Runs both directions of a bidirectional layer. The reverse one writes its outputs after those
  /// of the forward one in each frame.
  Sequence recurrent(const PreparedLayer& layer, Sequence in) {
    const Sequence out = fresh(in.frames, layer.outputs);
    direction(layer, layer.directions[0], in, writable(out), false);
    if (layer.layer.bidirectional) {
      direction(layer, layer.directions[1], in, writable(out) + layer.layer.out, true);
    }
    drop(in);
    return out;
  }

  /// Runs one direction of a recurrent layer. The products with the input are computed for all
  /// frames at once.
  void direction(const PreparedLayer& layer, const DirectionWeights& weights, const Sequence& in,
                 float* out, bool reverse) {
    const std::size_t units = layer.layer.out;
    const Sequence gates = fresh(in.frames, weights.from_input.outputs);
    Product input = weights.from_input.product();
    input.in = in.data;
    input.in_stride = in.channels;
    input.out = writable(gates);
    input.out_stride = gates.channels;
    input.frames = in.frames;
    kernels_.multiply(input);
    const Sequence state = fresh(1, 2 * units);  // output before the first frame, then the cell
    float* const cell = writable(state) + units;
    std::fill_n(writable(state), 2 * units, 0.0F);
    // A gru needs the sums of the state separately from those of the input. An lstm adds the sums
    // of the state to the gates.
    const Sequence scratch = fresh(1, gates.channels);
    // Each step reads the previous output where it was written, so nothing is copied.
    const float* previous = state.data;
    for (std::size_t i = 0; i < in.frames; ++i) {
      const std::size_t t = reverse ? in.frames - 1 - i : i;
      // The gates of frame t. They already contain the sums of the input.
      float* const gate = writable(gates) + t * gates.channels;
      Product recurrent = weights.from_state.product();
      recurrent.in = previous;
      recurrent.frames = 1;
      float* const next = out + t * layer.outputs;
      if (layer.layer.kind == LayerKind::lstm) {
        // The product has no bias, so its sums are added to `out`, here the sums of the input.
        recurrent.out = gate;
        kernels_.multiply(recurrent);
        kernels_.lstm_gates(gate, cell, next, units);
      } else {
        recurrent.out = writable(scratch);
        kernels_.multiply(recurrent);
        kernels_.gru_gates(gate, scratch.data, previous, next, units);
      }
      previous = next;
    }
    drop(scratch);
    drop(state);
    drop(gates);
  }

  /// Normalises each frame, in place if the values are in a block.
  Sequence layer_norm(const PreparedLayer& layer, Sequence in) {
    const Sequence out = in.block ? in : fresh(in.frames, in.channels);
    for (std::size_t t = 0; t < in.frames; ++t) {
      kernels_.layer_norm(in.data + t * in.channels, writable(out) + t * in.channels,
                          layer.norm_weight.data(), layer.norm_bias.data(), in.channels);
    }
    return out;
  }

  Sequence activation(const Layer& layer, Sequence in) {
    const Sequence out = owned(in);
    for (std::size_t t = 0; t < out.frames; ++t) {  // frame by frame, as in OnlineNetwork
      apply_activation(kernels_, layer, writable(out) + t * out.channels, out.channels);
    }
    return out;
  }

  Sequence slice(const PreparedLayer& layer, Sequence in) {
    const Sequence out = fresh(in.frames, layer.outputs);
    for (std::size_t t = 0; t < in.frames; ++t) {
      std::copy_n(in.data + t * in.channels + layer.layer.begin, out.channels,
                  writable(out) + t * out.channels);
    }
    drop(in);
    return out;
  }

  /// The larger of each two frames. The number of frames is kept for the unpooling.
  Sequence max_pool(Sequence in) {
    workspace_.frames_before_pools.push_back(in.frames);
    const Sequence out = fresh((in.frames + 1) / 2, in.channels);
    for (std::size_t t = 0; t < out.frames; ++t) {
      const float* first = in.data + 2 * t * in.channels;
      const float* second = 2 * t + 1 < in.frames ? first + in.channels : first;
      float* const values = writable(out) + t * out.channels;
      for (std::size_t c = 0; c < in.channels; ++c) values[c] = std::max(first[c], second[c]);
    }
    drop(in);
    return out;
  }

  /// Repeats each frame at half its value, up to the length before the matching max_pool.
  Sequence unpool(Sequence in) {
    const Sequence out = fresh(workspace_.frames_before_pools.back(), in.channels);
    workspace_.frames_before_pools.pop_back();
    for (std::size_t t = 0; t < out.frames; ++t) {
      const float* from = in.data + t / 2 * in.channels;
      float* const values = writable(out) + t * out.channels;
      for (std::size_t c = 0; c < in.channels; ++c) values[c] = 0.5F * from[c];
    }
    drop(in);
    return out;
  }

  /// Runs all branches on the same input, and joins, adds or multiplies their outputs.
  Sequence branches(const PreparedLayer& layer, Sequence in) {
    const Sequence out = fresh(in.frames, layer.outputs);
    // The shared input has no block, so no branch changes or returns the values that the next
    // branch reads.
    const Sequence shared{in.data, in.frames, in.channels, std::nullopt};
    std::size_t column = 0;
    for (std::size_t b = 0; b < layer.branches.size(); ++b) {
      const Sequence branch = list(layer.branches[b], shared);
      if (layer.layer.kind == LayerKind::concat) {
        write_columns(branch, out, column);
        column += branch.channels;
      } else if (b == 0) {
        std::copy_n(branch.data, branch.size(), writable(out));
      } else if (layer.layer.kind == LayerKind::sum) {
        kernels_.add(writable(out), branch.data, out.size());
      } else {
        kernels_.scale_by(writable(out), branch.data, out.size());
      }
      drop(branch);
    }
    drop(in);
    return out;
  }

  /// The values, extended to at least `frames` frames by repeating the last one.
  Sequence lengthened(Sequence in, std::size_t frames) {
    if (in.frames >= frames) return in;
    const Sequence out = fresh(frames, in.channels);
    float* const values = writable(out);
    std::copy_n(in.data, in.size(), values);
    for (std::size_t i = in.size(); i < out.size(); ++i) values[i] = values[i - in.channels];
    drop(in);
    return out;
  }

  /// Averages the branch's results over windows. Each window of a channel is one row of the
  /// branch's input; the branch runs on `window_block` rows at a time. The results are added up at
  /// their frames and divided by the number of windows at the end.
  Sequence along_time(const PreparedLayer& layer, Sequence in) {
    const std::size_t frames = in.frames, channels = in.channels, window = layer.layer.window;
    if (frames == 0) return in;
    in = lengthened(in, window);
    Sequence out = fresh(in.frames, channels);
    std::fill_n(writable(out), out.size(), 0.0F);
    const std::size_t windows = in.frames - window + 1;
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t begin = 0; begin < windows; begin += window_block) {
        const std::size_t at = begin * channels + c;
        Sequence rows = fresh(std::min(windows - begin, window_block), window);
        for (std::size_t i = 0; i < rows.size(); ++i) {
          // Row i / window and column i % window get the frame `begin` + row + column of this
          // channel.
          writable(rows)[i] = in.data[at + (i / window + i % window) * channels];
        }
        rows = list(layer.branches.front(), rows);
        for (std::size_t i = 0; i < rows.size(); ++i) {
          writable(out)[at + (i / window + i % window) * channels] += rows.data[i];
        }
        drop(rows);
      }
    }
    for (std::size_t t = 0; t < out.frames; ++t) {
      // Number of windows that contain frame t: fewer near both ends.
      const std::size_t count = std::min({t + 1, out.frames - t, window, windows});
      for (std::size_t c = 0; c < channels; ++c) {
        writable(out)[t * channels + c] /= static_cast<float>(count);
      }
    }
    drop(in);
    // Frames that were added to fill one window are cut off.
    out.frames = frames;
    return out;
  }

  /// Copies a branch's channels into their columns of the result.
  void write_columns(const Sequence& from, const Sequence& out, std::size_t column) {
    for (std::size_t t = 0; t < from.frames; ++t) {
      std::copy_n(from.data + t * from.channels, from.channels,
                  writable(out) + t * out.channels + column);
    }
  }

  const Kernels& kernels_;
  Workspace& workspace_;
};

}  // namespace

/// Applies the layer's activation to n values in place.
void apply_activation(const Kernels& kernels, const Layer& layer, float* values, std::size_t n) {
  switch (layer.kind) {
    case LayerKind::relu:
      return kernels.relu(values, n);
    case LayerKind::leaky_relu:
      return kernels.leaky_relu(values, n, static_cast<float>(layer.slope));
    case LayerKind::gelu:
      return kernels.gelu(values, n);
    case LayerKind::tanh:
      return kernels.tanh(values, n);
    case LayerKind::sigmoid:
      return kernels.sigmoid(values, n);
    default:
      assert(false);
  }
}

std::size_t Workspace::take(std::size_t values) {
  std::size_t free = 0;
  // The number of blocks is small: at most as many as sequences exist at the same time.
  while (free < blocks_.size() && blocks_[free].taken) ++free;
  if (free == blocks_.size()) blocks_.emplace_back();
  blocks_[free].taken = true;
  if (blocks_[free].values.size() < values) blocks_[free].values.resize(values);
  return free;
}

void Workspace::give_all_back() {
  for (Block& block : blocks_) block.taken = false;
  frames_before_pools.clear();
}

Result<Network> Network::make(const Architecture& architecture,
                              const std::map<std::string, Tensor>& tensors,
                              const std::string& prefix, const Kernels& kernels) {
  auto prepared = std::make_unique<PreparedNetwork>(KA_TRY(prepare(architecture, tensors, prefix)));
  prepared->kernels = &kernels;
  return Network(std::move(prepared));
}

Network::Network(std::unique_ptr<const PreparedNetwork> prepared)
    : prepared_(std::move(prepared)) {}
Network::Network(Network&&) noexcept = default;
Network& Network::operator=(Network&&) noexcept = default;
Network::~Network() = default;

const Architecture& Network::architecture() const { return prepared_->architecture; }
std::size_t Network::inputs() const { return prepared_->architecture.inputs; }
std::size_t Network::outputs() const { return prepared_->outputs; }

void Network::run(std::span<const float> in, std::size_t frames, Workspace& workspace,
                  std::vector<float>& out) const {
  assert(in.size() == frames * inputs());
  const FlushToZero flush;
  // The block with the result of the previous run is still taken.
  workspace.give_all_back();
  const Sequence found = Run(*prepared_->kernels, workspace)
                             .list(prepared_->layers, {in.data(), frames, inputs(), std::nullopt});
  out.assign(found.data, found.data + found.size());
}

}  // namespace kinalign
