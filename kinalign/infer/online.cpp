// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/online.h"

#include "kinalign/infer/flush_to_zero.h"
#include "kinalign/infer/prepared.h"

#include <algorithm>
#include <cassert>
#include <string_view>

namespace kinalign {

namespace {

/// The values that one layer keeps between frames, and its result.
/// All vectors get their size when the state is made. A step allocates nothing.
struct LayerState {
  const PreparedLayer* layer = nullptr;
  Values out;           // [outputs] the result of the last frame
  Values ring;          // conv: each of the last `rows` frames is stored twice, `rows` frames apart
  std::size_t row = 0;  // 0 ... rows - 1, place of the next frame
  std::size_t rows = 0;
  Values memory;      // lstm: output and cell; gru: output
  Values from_input;  // sums of the gates
  Values from_state;
  std::vector<std::vector<LayerState>> branches;
};

/// The reason why a layer needs later frames; empty if it does not.
std::string_view why_not_online(const Layer& layer) {
  if (layer.bidirectional) return "a bidirectional layer";
  if (layer.kind == LayerKind::max_pool) return "max_pool";
  if (layer.kind == LayerKind::along_time) return "along_time";
  if (layer.kind == LayerKind::conv && !layer.causal && layer.kernel > 1) {
    return "a centred convolution";
  }
  return "";
}

/// Room for a layer's state between frames: earlier inputs of a convolution, memory of a recurrent
/// layer.
LayerState state_of(const PreparedLayer& layer) {
  const std::size_t units = layer.layer.out;
  LayerState out;
  out.layer = &layer;
  out.out.resize(layer.outputs);
  if (layer.layer.kind == LayerKind::conv) {
    out.rows = (layer.layer.kernel - 1) * layer.layer.dilation + 1;
    out.ring.resize(2 * out.rows * layer.inputs);
  }
  if (layer.layer.kind == LayerKind::lstm) out.memory.resize(2 * units);
  if (layer.layer.kind == LayerKind::gru) {
    out.memory.resize(units);
    out.from_state.resize(3 * units);
  }
  out.from_input.resize(layer.directions[0].from_input.outputs);
  return out;
}

/// States for all layers; fails if one of them needs later frames.
Result<std::vector<LayerState>> states_of(const std::vector<PreparedLayer>& layers) {
  std::vector<LayerState> out;
  for (const PreparedLayer& layer : layers) {
    if (const auto why = why_not_online(layer.layer); !why.empty()) {
      return Failure(Error{"", 0, "layers that need no later frames, to run frame by frame",
                           std::string(why) + " as layer " + layer.path});
    }
    out.push_back(state_of(layer));
    for (const auto& branch : layer.branches) {
      out.back().branches.push_back(KA_TRY(states_of(branch)));
    }
  }
  return out;
}

/// Passes one frame through the layers. Each result is stored in the state of its layer.
/// Functions return the place of a result: the state of the layer, or the input itself for layers
/// that change nothing.
class Step {
 public:
  explicit Step(const Kernels& kernels) : kernels_(kernels) {}

  const float* list(std::vector<LayerState>& layers, const float* in) const {
    for (LayerState& layer : layers) in = one(layer, in);
    return in;
  }

 private:
  /// Runs one layer on one frame; gives the place of its output.
  const float* one(LayerState& state, const float* in) const {
    const PreparedLayer& layer = *state.layer;
    float* const out = state.out.data();
    switch (layer.layer.kind) {
      case LayerKind::linear:
        multiply(layer.weights, in, 0, out);
        return out;
      case LayerKind::conv:
        return conv(state, in);
      case LayerKind::lstm:
      case LayerKind::gru:
        return recurrent(state, in);
      case LayerKind::layer_norm:
        kernels_.layer_norm(in, out, layer.norm_weight.data(), layer.norm_bias.data(),
                            layer.inputs);
        return out;
      case LayerKind::dropout:
        return in;
      // No copy: the result is part of the input. So it is valid only as long as the input.
      case LayerKind::slice:
        return in + layer.layer.begin;
      case LayerKind::sum:
      case LayerKind::product:
      case LayerKind::concat:
        return branches(state, in);
      default:
        std::copy_n(in, layer.inputs, out);
        apply_activation(kernels_, layer.layer, out, layer.outputs);
        return out;
    }
  }

  /// One product with a single frame.
  void multiply(const PackedWeights& weights, const float* in, std::size_t tap_stride,
                float* out) const {
    Product product = weights.product();
    product.in = in;
    product.tap_stride = tap_stride;
    product.out = out;
    product.frames = 1;
    kernels_.multiply(product);
  }

  /// Each frame is written twice, so that the last `rows` frames are always contiguous.
  /// `row` is the place of the next frame in the first copy.
  const float* conv(LayerState& state, const float* in) const {
    const PreparedLayer& layer = *state.layer;
    float* const first = state.ring.data() + state.row * layer.inputs;
    std::copy_n(in, layer.inputs, first);
    std::copy_n(in, layer.inputs, first + state.rows * layer.inputs);
    state.row = state.row + 1 == state.rows ? 0 : state.row + 1;
    // The oldest frame is at the place of the next frame. In the second copy all later frames
    // follow the oldest one.
    const float* const oldest =
        state.ring.data() + (state.row == 0 ? state.rows : state.row) * layer.inputs;
    multiply(layer.weights, oldest, layer.layer.dilation * layer.inputs, state.out.data());
    return state.out.data();
  }

  /// One frame of an LSTM or a GRU; updates its memory.
  const float* recurrent(LayerState& state, const float* in) const {
    const PreparedLayer& layer = *state.layer;
    const DirectionWeights& weights = layer.directions[0];
    const std::size_t units = layer.layer.out;
    float* const memory = state.memory.data();
    float* const gates = state.from_input.data();
    multiply(weights.from_input, in, 0, gates);
    if (layer.layer.kind == LayerKind::lstm) {
      multiply(weights.from_state, memory, 0, gates);
      kernels_.lstm_gates(gates, memory + units, memory, units);
    } else {
      multiply(weights.from_state, memory, 0, state.from_state.data());
      // The output replaces the previous one in place, which gru_gates allows.
      kernels_.gru_gates(gates, state.from_state.data(), memory, memory, units);
    }
    return memory;
  }

  /// Runs all branches on a frame, and joins, adds or multiplies their outputs.
  const float* branches(LayerState& state, const float* in) const {
    const PreparedLayer& layer = *state.layer;
    float* out = state.out.data();
    for (std::size_t b = 0; b < state.branches.size(); ++b) {
      const float* const found = list(state.branches[b], in);
      // An empty branch is the identity.
      const std::size_t channels =
          layer.branches[b].empty() ? layer.inputs : layer.branches[b].back().outputs;
      if (layer.layer.kind == LayerKind::concat) {
        std::copy_n(found, channels, out);
        out += channels;
      } else if (b == 0) {
        std::copy_n(found, channels, out);
      } else if (layer.layer.kind == LayerKind::sum) {
        kernels_.add(out, found, channels);
      } else {
        kernels_.scale_by(out, found, channels);
      }
    }
    return state.out.data();
  }

  const Kernels& kernels_;
};

/// Calls visit(Values&) with the memory of every recurrent layer, in order.
template <class States, class Visit>
void for_each_memory(States& layers, const Visit& visit) {
  for (auto& layer : layers) {
    visit(layer.memory);
    for (auto& branch : layer.branches) for_each_memory(branch, visit);
  }
}

// Frames before the first one are zeros, as in Network::run.
void clear(std::vector<LayerState>& layers) {
  for (LayerState& layer : layers) {
    std::fill(layer.ring.begin(), layer.ring.end(), 0.0F);
    std::fill(layer.memory.begin(), layer.memory.end(), 0.0F);
    layer.row = 0;
    for (auto& branch : layer.branches) clear(branch);
  }
}

}  // namespace

struct OnlineNetwork::State {
  const PreparedNetwork* network = nullptr;
  std::vector<LayerState> layers;
};

// The pointer to the prepared layers stays valid if the network is moved.
Result<OnlineNetwork> OnlineNetwork::make(const Network& network) {
  auto state = std::make_unique<State>();
  state->network = network.prepared_.get();
  state->layers = KA_TRY(states_of(network.prepared_->layers));
  return OnlineNetwork(std::move(state));
}

OnlineNetwork::OnlineNetwork(std::unique_ptr<State> state) : state_(std::move(state)) {}
OnlineNetwork::OnlineNetwork(OnlineNetwork&&) noexcept = default;
OnlineNetwork& OnlineNetwork::operator=(OnlineNetwork&&) noexcept = default;
OnlineNetwork::~OnlineNetwork() = default;

std::span<const float> OnlineNetwork::step(std::span<const float> frame) {
  assert(frame.size() == state_->network->architecture.inputs);
  const FlushToZero flush;
  return {Step(*state_->network->kernels).list(state_->layers, frame.data()),
          state_->network->outputs};
}

void OnlineNetwork::reset() { clear(state_->layers); }

std::size_t OnlineNetwork::state_size() const {
  std::size_t size = 0;
  for_each_memory(state_->layers, [&size](const Values& memory) { size += memory.size(); });
  return size;
}

void OnlineNetwork::get_state(std::span<float> state) const {
  assert(state.size() == state_size());
  auto at = state.begin();
  for_each_memory(state_->layers, [&at](const Values& memory) {
    at = std::copy(memory.begin(), memory.end(), at);
  });
}

void OnlineNetwork::set_state(std::span<const float> state) {
  assert(state.size() == state_size());
  auto at = state.begin();
  for_each_memory(state_->layers, [&at](Values& memory) {
    std::copy_n(at, memory.size(), memory.begin());
    at += static_cast<std::ptrdiff_t>(memory.size());
  });
}

}  // namespace kinalign
