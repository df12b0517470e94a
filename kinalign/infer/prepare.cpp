// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/prepare.h"

#include "kinalign/infer/shapes.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

using Tensors = std::map<std::string, Tensor>;

// A shape for messages: "[64,75]".
std::string text_of(const std::vector<std::size_t>& shape) {
  std::string out = "[";
  for (const std::size_t n : shape) out += (out.size() > 1 ? "," : "") + std::to_string(n);
  return out + "]";
}

// The number of outputs, rounded up to whole panels.
std::size_t padded(std::size_t outputs) {
  return (outputs + panel_width - 1) / panel_width * panel_width;
}

/// Packs [outputs,channels,taps] into panels.
PackedWeights pack(const Tensor& tensor, const Tensor* bias) {
  PackedWeights out;
  out.outputs = tensor.shape[0];
  out.channels = tensor.shape[1];
  out.taps = tensor.shape.size() == 3 ? tensor.shape[2] : 1;
  const std::size_t depth = out.taps * out.channels;
  out.weights.assign(padded(out.outputs) * depth, 0.0F);
  for (std::size_t n = 0; n < out.outputs; ++n) {
    // The 16 outputs of a panel lie side by side, so the kernel loads them as vectors.
    const std::size_t panel = n / panel_width * depth * panel_width + n % panel_width;
    for (std::size_t c = 0; c < out.channels; ++c) {
      for (std::size_t k = 0; k < out.taps; ++k) {
        out.weights[panel + (k * out.channels + c) * panel_width] =
            tensor.values[n * depth + c * out.taps + k];
      }
    }
  }
  if (bias != nullptr) {
    out.bias.assign(padded(out.outputs), 0.0F);
    std::copy(bias->values.begin(), bias->values.end(), out.bias.begin());
  }
  return out;
}

/// Packs one layer after another. check_tensors() must have succeeded.
class Packer {
 public:
  Packer(const Tensors& tensors, std::string prefix)
      : tensors_(tensors), prefix_(std::move(prefix)) {}

  std::vector<PreparedLayer> list(const std::vector<Layer>& layers, std::size_t inputs,
                                  const std::string& path) const {
    std::vector<PreparedLayer> out;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      out.push_back(one(layers[i], inputs, path_below(path, i)));
      inputs = out.back().outputs;
    }
    return out;
  }

 private:
  /// Packs the tensors of one layer, and of its branches, for the kernels.
  PreparedLayer one(const Layer& layer, std::size_t inputs, const std::string& path) const {
    PreparedLayer out;
    out.layer = layer;
    out.layer.branches.clear();
    out.path = path;
    out.inputs = inputs;
    out.outputs = outputs(layer, inputs);
    switch (layer.kind) {
      case LayerKind::linear:
      case LayerKind::conv:
        out.weights = pack(tensor(path, "weight"), &tensor(path, "bias"));
        break;
      case LayerKind::lstm:
      case LayerKind::gru:
        out.directions[0] = direction(layer, path, "_l0");
        if (layer.bidirectional) out.directions[1] = direction(layer, path, "_l0_reverse");
        break;
      case LayerKind::layer_norm:
        out.norm_weight.assign(tensor(path, "weight").values.begin(),
                               tensor(path, "weight").values.end());
        out.norm_bias.assign(tensor(path, "bias").values.begin(),
                             tensor(path, "bias").values.end());
        break;
      default:
        for (std::size_t b = 0; b < layer.branches.size(); ++b) {
          out.branches.push_back(
              list(layer.branches[b], branch_inputs(layer, inputs), path_below(path, b)));
        }
    }
    return out;
  }

  /// In an lstm the two biases are always added, so they are added here once. In a gru the reset
  /// gate acts on the second bias, so both are kept.
  DirectionWeights direction(const Layer& layer, const std::string& path,
                             const std::string& ending) const {
    const Tensor& bias_hh = tensor(path, "bias_hh" + ending);
    DirectionWeights out;
    out.from_input = pack(tensor(path, "weight_ih" + ending), &tensor(path, "bias_ih" + ending));
    const bool lstm = layer.kind == LayerKind::lstm;
    out.from_state = pack(tensor(path, "weight_hh" + ending), lstm ? nullptr : &bias_hh);
    for (std::size_t i = 0; lstm && i < bias_hh.values.size(); ++i) {
      out.from_input.bias[i] += bias_hh.values[i];
    }
    return out;
  }

  /// A tensor by the layer's path; check_tensors() has made sure that it exists.
  const Tensor& tensor(const std::string& path, const std::string& what) const {
    return tensors_.at(prefix_ + path + "." + what);
  }

  const Tensors& tensors_;
  std::string prefix_;
};

}  // namespace

// A value that is not finite would spread to all later results, so it is refused here and the
// kernels need no check.
Result<void> check_tensors(const Architecture& architecture, const Tensors& tensors,
                           const std::string& prefix) {
  for (const Parameter& needed : parameters(architecture)) {
    const std::string name = prefix + needed.name;
    const auto found = tensors.find(name);
    if (found == tensors.end()) {
      return Failure(Error{"", 0, "tensor " + shown(name) + " " + text_of(needed.shape), "none"});
    }
    const Tensor& tensor = found->second;
    if (tensor.shape != needed.shape) {
      return Failure(Error{"", 0, "tensor " + shown(name) + " " + text_of(needed.shape),
                           text_of(tensor.shape)});
    }
    const auto finite = [](float value) { return std::isfinite(value); };
    if (!std::all_of(tensor.values.begin(), tensor.values.end(), finite)) {
      return Failure(Error{"", 0, "finite numbers in tensor " + shown(name), "others"});
    }
  }
  return {};
}

Product PackedWeights::product() const {
  Product out;
  out.taps = taps;
  out.channels = channels;
  out.weights = weights.data();
  out.bias = bias.empty() ? nullptr : bias.data();
  out.outputs = outputs;
  return out;
}

// The order matters: the list of tensors needs a valid architecture, and packing needs tensors of
// the right shape.
Result<PreparedNetwork> prepare(const Architecture& architecture, const Tensors& tensors,
                                const std::string& prefix) {
  KA_TRY(validate(architecture));
  KA_TRY(check_tensors(architecture, tensors, prefix));
  PreparedNetwork out;
  out.architecture = architecture;
  out.outputs = outputs(architecture);
  out.layers = Packer(tensors, prefix).list(architecture.layers, architecture.inputs, "");
  return out;
}

}  // namespace kinalign
