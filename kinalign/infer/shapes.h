// SPDX-License-Identifier: Apache-2.0
// Facts that follow from an architecture alone: its tensors, its channels, the frames that it uses.
// `infer` loads the tensors listed here and `learn` trains them.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/architecture.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Limits of an architecture. A model's file may come from anywhere. The limits bound the memory
/// and the depth of recursion that it can cause.
inline constexpr std::size_t most_layers = 1000;  // in all branches together
inline constexpr std::size_t most_depth = 8;      // depth of nested branches
inline constexpr std::size_t most_channels = 16384;
inline constexpr std::size_t most_kernel = 1023;
inline constexpr std::size_t most_dilation = 4096;
inline constexpr std::size_t most_parameters = 200'000'000;
/// Limit of the values of other frames that all convolutions together store for the next frame.
inline constexpr std::size_t most_kept = std::size_t{1} << 26U;

/// A tensor that an architecture needs. Values are row-major.
struct Parameter {
  std::string name;  // "3.1.0.weight"
  std::vector<std::size_t> shape;

  bool operator==(const Parameter&) const = default;
};

/// Fails if a layer does not fit the layer before it, or if a limit above is exceeded. The error
/// names the layer. Each unpool belongs to the last open max_pool in its own list of layers. Within
/// a branch every max_pool needs an unpool. Layers within an along_time must process each row alone
/// (linear, layer_norm, slice, or a function of single values). The functions below need a valid
/// architecture, so this function is called for each one that is read, made or exported.
Result<void> validate(const Architecture& architecture);

/// All tensors, in the order of the layers.
/// `prepare` (infer) and `learn` both go by this list, so both have the same tensors.
std::vector<Parameter> parameters(const Architecture& architecture);

/// Output channels of the last layer, of one layer, or of a list of layers with `inputs` channels.
std::size_t outputs(const Architecture& architecture);
std::size_t outputs(const Layer& layer, std::size_t inputs);
std::size_t outputs(const std::vector<Layer>& layers, std::size_t inputs);
/// Input channels of each branch of a layer.
std::size_t branch_inputs(const Layer& layer, std::size_t inputs);

/// The number of frames after (look_ahead) or before (look_back) a frame that can change the result
/// at that frame. Empty if the whole sequence can: in bidirectional and pooled networks, and for
/// look_back in all recurrent networks.
std::optional<std::size_t> look_ahead(const Architecture& architecture);
std::optional<std::size_t> look_back(const Architecture& architecture);

/// The path of layer or branch `index` below `path`: "3.1.0" is layer 0 of branch 1 of layer 3. An
/// empty `path` means the architecture itself.
std::string path_below(std::string_view path, std::size_t index);

}  // namespace kinalign
