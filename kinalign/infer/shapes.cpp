// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/shapes.h"

#include "kinalign/infer/layer_kinds.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

Failure wrong(const std::string& path, const std::string& expected, const std::string& found) {
  return Failure(Error{"", 0, expected + " in layer " + path, found});
}

// "3 taps", for messages.
std::string counted(std::size_t number, std::string_view noun) {
  return std::to_string(number) + " " + std::string(noun);
}

/// Checks 1 <= found <= most; the message says, for example, "1 to 1023 taps".
Result<void> within(const std::string& path, std::size_t found, std::size_t most,
                    std::string_view noun) {
  if (found >= 1 && found <= most) return {};
  return wrong(path, "1 to " + counted(most, noun), std::to_string(found));
}

/// A layer with the members that its kind uses and no others.
Layer only_used_members(const Layer& layer) {
  Layer out;
  out.kind = layer.kind;
  if (uses(layer.kind, member_out)) out.out = layer.out;
  if (uses(layer.kind, member_kernel)) out.kernel = layer.kernel;
  if (uses(layer.kind, member_dilation)) out.dilation = layer.dilation;
  if (uses(layer.kind, member_causal)) out.causal = layer.causal;
  if (uses(layer.kind, member_bidirectional)) out.bidirectional = layer.bidirectional;
  if (uses(layer.kind, member_slope)) out.slope = layer.slope;
  if (uses(layer.kind, member_rate)) out.rate = layer.rate;
  if (uses(layer.kind, member_begin)) out.begin = layer.begin;
  if (uses(layer.kind, member_branches)) out.branches = layer.branches;
  if (uses(layer.kind, member_window)) out.window = layer.window;
  return out;
}

/// Number of parameters of one layer without its branches. At most 2^43, so it can't overflow
/// within the limits.
std::size_t own_parameters(const Layer& layer, std::size_t inputs) {
  const std::size_t directions = layer.bidirectional ? 2 : 1;
  switch (layer.kind) {
    case LayerKind::linear:
    case LayerKind::conv:
      return layer.out * inputs * layer.kernel + layer.out;
    case LayerKind::lstm:
      return directions * 4 * layer.out * (inputs + layer.out + 2);
    case LayerKind::gru:
      return directions * 3 * layer.out * (inputs + layer.out + 2);
    case LayerKind::layer_norm:
      return 2 * inputs;
    default:
      return 0;
  }
}

/// True if a layer processes each row (frame) alone.
bool is_row_by_row(const Layer& layer) {
  switch (layer.kind) {
    case LayerKind::conv:
    case LayerKind::lstm:
    case LayerKind::gru:
    case LayerKind::max_pool:
    case LayerKind::unpool:
    case LayerKind::along_time:
      return false;
    default:
      return std::all_of(layer.branches.begin(), layer.branches.end(), [](const auto& branch) {
        return std::all_of(branch.begin(), branch.end(), is_row_by_row);
      });
  }
}

/// Visits all layers, counts them and checks the limits.
/// Recursion is limited by `most_depth`, so a hostile file can't exhaust the stack.
class Check {
 public:
  /// Checks `layers`; returns the output channels of the last one.
  Result<std::size_t> list(const std::vector<Layer>& layers, std::size_t inputs,
                           const std::string& path, std::size_t depth) {
    std::size_t channels = inputs;
    std::size_t pools = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const std::string place = path_below(path, i);
      channels = KA_TRY(one(layers[i], channels, place, depth));
      // Pools and unpools are nested like brackets: each unpool ends the last open pool of the same
      // list of layers.
      if (layers[i].kind == LayerKind::max_pool) ++pools;
      if (layers[i].kind != LayerKind::unpool) continue;
      if (pools == 0) return wrong(place, "a max_pool before the unpool", "none");
      --pools;
    }
    // A branch must return as many frames as it gets, because its result is joined with that of
    // other branches. Outside of branches an open pool shortens the result of the network.
    if (depth > 0 && pools > 0) {
      return wrong(path, "an unpool for each max_pool of a branch", counted(pools, "without one"));
    }
    return channels;
  }

 private:
  /// Checks one layer; returns its output channels. The counts of layers, parameters and kept
  /// values include all branches.
  Result<std::size_t> one(const Layer& layer, std::size_t inputs, const std::string& path,
                          std::size_t depth) {
    if (static_cast<std::size_t>(layer.kind) >= kind_rows.size()) {
      return wrong(path, "a kind", "number " + std::to_string(static_cast<int>(layer.kind)));
    }
    if (++layers_ > most_layers) {
      return wrong(path, "at most " + counted(most_layers, "layers up to and"), "more");
    }
    // A member that the kind does not use would be lost when the network is written. Such a layer
    // is an error.
    if (!(only_used_members(layer) == layer)) {
      return wrong(path, "only members of " + std::string(row_of(layer.kind).name), "others");
    }
    KA_TRY(members(layer, inputs, path));
    // The sum can't overflow: it is checked after each layer.
    parameters_ += own_parameters(layer, inputs);
    if (parameters_ > most_parameters) {
      return wrong(path, "at most " + counted(most_parameters, "parameters up to and"),
                   std::to_string(parameters_));
    }
    // Frames that a convolution keeps when the network runs frame by frame.
    kept_ += (layer.kernel - 1) * layer.dilation * inputs;
    if (kept_ > most_kept) {
      return wrong(path, "at most " + counted(most_kept, "values kept of other frames up to and"),
                   std::to_string(kept_));
    }
    if (layer.kind == LayerKind::along_time) return along_time(layer, inputs, path, depth);
    if (uses(layer.kind, member_branches)) return branches(layer, inputs, path, depth);
    return outputs(layer, inputs);
  }

  /// Checks that each number of a layer is within its limits.
  static Result<void> members(const Layer& layer, std::size_t inputs, const std::string& path) {
    if (uses(layer.kind, member_out)) {
      const std::size_t directions = layer.bidirectional ? 2 : 1;
      KA_TRY(within(path, layer.out, most_channels / directions, "channels"));
    }
    KA_TRY(within(path, layer.kernel, most_kernel, "taps"));
    KA_TRY(within(path, layer.dilation, most_dilation, "frames of dilation"));
    // A centred convolution has as many taps before its frame as after it.
    if (!layer.causal && layer.kernel % 2 == 0) {
      return wrong(path, "an odd number of taps, as the convolution is centred",
                   std::to_string(layer.kernel));
    }
    KA_TRY(within(path, layer.window, most_kernel, "frames of a window"));
    if (!std::isfinite(layer.slope)) return wrong(path, "a finite slope", "none");
    if (!(layer.rate >= 0.0 && layer.rate < 1.0)) {
      return wrong(path, "a rate from 0 to below 1", std::to_string(layer.rate));
    }
    // The check is written as a difference, because a sum of two numbers from a file could wrap.
    if (layer.kind == LayerKind::slice &&
        (layer.begin > inputs || layer.out > inputs - layer.begin)) {
      return wrong(path, "a slice of " + counted(inputs, "channels"),
                   "channels " + std::to_string(layer.begin) + " to " +
                       std::to_string(layer.begin + layer.out - 1));
    }
    return {};
  }

  /// Checks all branches; returns the channels of their joined result. Branches of a sum or a
  /// product must have equal channels.
  Result<std::size_t> branches(const Layer& layer, std::size_t inputs, const std::string& path,
                               std::size_t depth) {
    if (depth == most_depth) {
      return wrong(path, "at most " + counted(most_depth, "branches within branches"), "more");
    }
    KA_TRY(within(path, layer.branches.size(), most_layers, "branches"));
    std::size_t channels = 0;
    for (std::size_t b = 0; b < layer.branches.size(); ++b) {
      const std::string place = path_below(path, b);
      const std::size_t found = KA_TRY(list(layer.branches[b], inputs, place, depth + 1));
      if (layer.kind == LayerKind::concat) {
        channels += found;
        KA_TRY(within(path, channels, most_channels, "channels"));
      } else if (b == 0) {
        channels = found;
      } else if (found != channels) {
        return wrong(place, counted(channels, "channels, as in branch 0,"), std::to_string(found));
      }
    }
    return channels;
  }

  /// Checks the branch, whose frames are windows of one channel. Its layers must not mix windows.
  Result<std::size_t> along_time(const Layer& layer, std::size_t inputs, const std::string& path,
                                 std::size_t depth) {
    const auto& all = layer.branches;
    if (all.size() != 1) return wrong(path, "one branch", std::to_string(all.size()));
    const std::size_t found = KA_TRY(branches(layer, layer.window, path, depth));
    if (!std::all_of(all.front().begin(), all.front().end(), is_row_by_row)) {
      return wrong(path, "a branch whose layers process each row separately", "others");
    }
    if (found == layer.window) return inputs;
    return wrong(path, counted(layer.window, "channels after the branch"), std::to_string(found));
  }

  /// Totals of the layers visited so far.
  std::size_t layers_ = 0, parameters_ = 0, kept_ = 0;
};

// ---- tensors

void list_tensors(const std::vector<Layer>& layers, std::size_t inputs, const std::string& path,
                  std::vector<Parameter>& out);

// Names of PyTorch's modules: "_l0" is the only layer, "_reverse" the second direction.
void list_recurrent(const Layer& layer, std::size_t inputs, const std::string& path,
                    std::vector<Parameter>& out) {
  const std::size_t rows = (layer.kind == LayerKind::lstm ? 4 : 3) * layer.out;
  for (const std::string_view direction : {"", "_reverse"}) {
    if (!direction.empty() && !layer.bidirectional) continue;
    const auto name = [&](std::string_view what) {
      return path + "." + std::string(what) + "_l0" + std::string(direction);
    };
    out.push_back({name("weight_ih"), {rows, inputs}});
    out.push_back({name("weight_hh"), {rows, layer.out}});
    out.push_back({name("bias_ih"), {rows}});
    out.push_back({name("bias_hh"), {rows}});
  }
}

void list_tensors(const Layer& layer, std::size_t inputs, const std::string& path,
                  std::vector<Parameter>& out) {
  switch (layer.kind) {
    case LayerKind::linear:
      out.push_back({path + ".weight", {layer.out, inputs}});
      out.push_back({path + ".bias", {layer.out}});
      break;
    case LayerKind::conv:
      out.push_back({path + ".weight", {layer.out, inputs, layer.kernel}});
      out.push_back({path + ".bias", {layer.out}});
      break;
    case LayerKind::lstm:
    case LayerKind::gru:
      list_recurrent(layer, inputs, path, out);
      break;
    case LayerKind::layer_norm:
      out.push_back({path + ".weight", {inputs}});
      out.push_back({path + ".bias", {inputs}});
      break;
    default:
      for (std::size_t b = 0; b < layer.branches.size(); ++b) {
        list_tensors(layer.branches[b], branch_inputs(layer, inputs), path_below(path, b), out);
      }
  }
}

void list_tensors(const std::vector<Layer>& layers, std::size_t inputs, const std::string& path,
                  std::vector<Parameter>& out) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    list_tensors(layers[i], inputs, path_below(path, i), out);
    inputs = outputs(layers[i], inputs);
  }
}

// ---- frames

enum class Side { before, after };

std::optional<std::size_t> reach(const std::vector<Layer>& layers, Side side);

/// The number of frames before or after a frame that its output depends on; nullopt: all.
std::optional<std::size_t> reach(const Layer& layer, Side side) {
  const std::size_t taps = (layer.kernel - 1) * layer.dilation;
  std::size_t most = 0;
  switch (layer.kind) {
    case LayerKind::conv:
      // A causal convolution has all its taps at and before the frame.
      if (layer.causal) return side == Side::before ? taps : 0;
      return taps / 2;
    case LayerKind::lstm:
    case LayerKind::gru:
      if (side == Side::after && !layer.bidirectional) return 0;
      return std::nullopt;
    case LayerKind::max_pool:
    case LayerKind::unpool:
      return std::nullopt;
    case LayerKind::along_time:
      // A frame's result is a mean over all windows that contain it.
      return layer.window - 1;
    default:
      for (const auto& branch : layer.branches) {
        const auto found = reach(branch, side);
        if (!found) return std::nullopt;
        most = std::max(most, *found);
      }
      return most;
  }
}

// The distances of successive layers add up.
std::optional<std::size_t> reach(const std::vector<Layer>& layers, Side side) {
  std::size_t all = 0;
  for (const Layer& layer : layers) {
    const auto found = reach(layer, side);
    if (!found) return std::nullopt;
    all += *found;
  }
  return all;
}

}  // namespace

Result<void> validate(const Architecture& architecture) {
  if (architecture.inputs < 1 || architecture.inputs > most_channels) {
    return Failure(Error{"", 0, "1 to " + counted(most_channels, "inputs of a network"),
                         std::to_string(architecture.inputs)});
  }
  KA_TRY(Check{}.list(architecture.layers, architecture.inputs, "", 0));
  return {};
}

std::vector<Parameter> parameters(const Architecture& architecture) {
  std::vector<Parameter> out;
  list_tensors(architecture.layers, architecture.inputs, "", out);
  return out;
}

std::size_t outputs(const Architecture& architecture) {
  return outputs(architecture.layers, architecture.inputs);
}

std::size_t outputs(const Layer& layer, std::size_t inputs) {
  std::size_t all = 0;
  switch (layer.kind) {
    case LayerKind::linear:
    case LayerKind::conv:
    case LayerKind::slice:
      return layer.out;
    case LayerKind::lstm:
    case LayerKind::gru:
      return layer.bidirectional ? 2 * layer.out : layer.out;
    case LayerKind::sum:
    case LayerKind::product:
      return outputs(layer.branches.front(), inputs);
    case LayerKind::concat:
      for (const auto& branch : layer.branches) all += outputs(branch, inputs);
      return all;
    default:
      return inputs;
  }
}

std::size_t outputs(const std::vector<Layer>& layers, std::size_t inputs) {
  for (const Layer& layer : layers) inputs = outputs(layer, inputs);
  return inputs;
}

// The branch of an along_time gets the frames of a window as its channels.
std::size_t branch_inputs(const Layer& layer, std::size_t inputs) {
  return layer.kind == LayerKind::along_time ? layer.window : inputs;
}

std::optional<std::size_t> look_ahead(const Architecture& architecture) {
  return reach(architecture.layers, Side::after);
}

std::optional<std::size_t> look_back(const Architecture& architecture) {
  return reach(architecture.layers, Side::before);
}

std::string path_below(std::string_view path, std::size_t index) {
  std::string out(path);
  if (!out.empty()) out += '.';
  out += std::to_string(index);
  return out;
}

}  // namespace kinalign
