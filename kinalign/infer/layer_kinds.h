// SPDX-License-Identifier: Apache-2.0
// A table of the kinds of layers: the name of each kind in a file, and the members of Layer that it
// uses.
#pragma once

#include "kinalign/infer/architecture.h"

#include <array>
#include <string_view>

namespace kinalign {

/// Members of Layer, as bits of KindRow::members.
/// Reading, writing and checking of a layer's members go by these bits.
enum LayerMember : unsigned {
  member_out = 1U,
  member_kernel = 2U,
  member_dilation = 4U,
  member_causal = 8U,
  member_bidirectional = 16U,
  member_slope = 32U,
  member_rate = 64U,
  member_begin = 128U,
  member_branches = 256U,
  member_window = 512U,
};

struct KindRow {
  LayerKind kind;
  std::string_view name;
  unsigned members;
};

/// The names are those in a model's file: docs/formats/model.md, "Architecture".
inline constexpr std::array<KindRow, 18> kind_rows{{
    {LayerKind::linear, "linear", member_out},
    {LayerKind::conv, "conv", member_out | member_kernel | member_dilation | member_causal},
    {LayerKind::lstm, "lstm", member_out | member_bidirectional},
    {LayerKind::gru, "gru", member_out | member_bidirectional},
    {LayerKind::layer_norm, "layer_norm", 0},
    {LayerKind::relu, "relu", 0},
    {LayerKind::leaky_relu, "leaky_relu", member_slope},
    {LayerKind::gelu, "gelu", 0},
    {LayerKind::tanh, "tanh", 0},
    {LayerKind::sigmoid, "sigmoid", 0},
    {LayerKind::dropout, "dropout", member_rate},
    {LayerKind::slice, "slice", member_out | member_begin},
    {LayerKind::max_pool, "max_pool", 0},
    {LayerKind::unpool, "unpool", 0},
    {LayerKind::sum, "sum", member_branches},
    {LayerKind::product, "product", member_branches},
    {LayerKind::concat, "concat", member_branches},
    {LayerKind::along_time, "along_time", member_window | member_branches},
}};

constexpr bool rows_in_order() {
  for (std::size_t i = 0; i < kind_rows.size(); ++i) {
    if (kind_rows[i].kind != static_cast<LayerKind>(i)) return false;
  }
  return true;
}
static_assert(rows_in_order(), "row_of finds a kind by its number");

constexpr const KindRow& row_of(LayerKind kind) {
  return kind_rows[static_cast<std::size_t>(kind)];
}

/// True if layers of this kind have the member. Members that a kind does not use must keep their
/// defaults.
constexpr bool uses(LayerKind kind, LayerMember member) {
  return (row_of(kind).members & member) != 0;
}

}  // namespace kinalign
