// SPDX-License-Identifier: Apache-2.0
// Field numbers: onnx/onnx.proto3. Operators: onnx/docs/Operators.md at opset 13, which has no
// LayerNormalization and no Gelu; both are written as simpler operators.
#include "kinalign/infer/onnx.h"

#include "kinalign/infer/prepare.h"
#include "kinalign/infer/protobuf.h"
#include "kinalign/infer/shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

using Tensors = std::map<std::string, Tensor>;
using Names = std::vector<std::string>;
using Numbers = std::vector<std::int64_t>;

// ONNX 1.8 has IR version 7 and opset 13.
constexpr std::int64_t ir_version = 7, opset = 13;
constexpr std::int64_t type_float = 1, type_int64 = 7;  // TensorProto.DataType

Numbers signed_shape(const std::vector<std::size_t>& shape) { return {shape.begin(), shape.end()}; }

// ---- AttributeProto: name 1, f 2, i 3, ints 8, s 4, type 20

// Field 20 states which of the value fields is used: 1 float, 2 int, 3 string, 7 ints.
ProtobufMessage float_attribute(std::string_view name, float value) {
  return ProtobufMessage().add(1, name).add(2, value).add(20, std::int64_t{1});
}

ProtobufMessage attribute(std::string_view name, std::int64_t value) {
  return ProtobufMessage().add(1, name).add(3, value).add(20, std::int64_t{2});
}

ProtobufMessage text_attribute(std::string_view name, std::string_view text) {
  return ProtobufMessage().add(1, name).add(4, text).add(20, std::int64_t{3});
}

ProtobufMessage list_attribute(std::string_view name, const Numbers& values) {
  ProtobufMessage out;
  out.add(1, name);
  for (const std::int64_t value : values) out.add(8, value);
  return out.add(20, std::int64_t{7});
}

/// TensorProto: dims 1, data_type 2, name 8, raw_data 9.
ProtobufMessage tensor_message(const std::string& name, std::int64_t type, const Numbers& shape,
                               std::string_view bytes) {
  ProtobufMessage out;
  for (const std::int64_t size : shape) out.add(1, size);
  return out.add(2, type).add(8, name).add(9, bytes);
}

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// ValueInfoProto of [1,T,channels].
ProtobufMessage value_info(const std::string& name, const std::string& frames,
                           std::size_t channels) {
  ProtobufMessage shape;
  shape.add(1, ProtobufMessage().add(1, std::int64_t{1}));
  shape.add(1, ProtobufMessage().add(2, frames));
  shape.add(1, ProtobufMessage().add(1, static_cast<std::int64_t>(channels)));
  const auto tensor = ProtobufMessage().add(1, type_float).add(2, shape);
  return ProtobufMessage().add(1, name).add(2, ProtobufMessage().add(1, tensor));
}

/// Builds the nodes and constants of a GraphProto. Each layer's function adds its nodes and returns
/// the name of the result [1,T,C].
/// Names of values begin with the path of their layer and end with a running number, so they are
/// unique.
class Graph {
 public:
  Graph(const Tensors& tensors, const std::string& prefix) : tensors_(tensors), prefix_(prefix) {}

  std::string list(const std::vector<Layer>& layers, std::string value, std::size_t channels,
                   const std::string& path) {
    Names pools;  // inputs of max_pools whose unpool comes later
    for (std::size_t i = 0; i < layers.size(); ++i) {
      path_ = path_below(path, i);
      if (layers[i].kind == LayerKind::max_pool) pools.push_back(value);
      if (layers[i].kind == LayerKind::unpool) {
        value = unpool(value, pools.back(), channels);
        pools.pop_back();
      } else {
        value = one(layers[i], value, channels);
      }
      channels = outputs(layers[i], channels);
    }
    return value;
  }

  /// NodeProto: input 1, output 2, name 3, op_type 4, attribute 5.
  std::string node(const std::string& op, const Names& inputs,
                   const std::vector<ProtobufMessage>& attributes = {}, std::string result = "") {
    if (result.empty()) result = path_ + "/" + op + "_" + std::to_string(++values_);
    ProtobufMessage out;
    for (const std::string& input : inputs) out.add(1, input);
    out.add(2, result).add(3, result + "_node").add(4, op);
    for (const ProtobufMessage& attribute : attributes) out.add(5, attribute);
    graph_.add(1, out);
    return result;
  }

  /// GraphProto: node 1, name 2, initializer 5 (in `constants_`), input 11, output 12.
  /// Nodes and constants were collected in two messages; fields of a message may be joined in any
  /// order.
  std::string finish(const ProtobufMessage& input, const ProtobufMessage& output) {
    graph_.add(2, "kinalign");
    std::string out = graph_.bytes() + constants_.bytes();
    return out + ProtobufMessage().add(11, input).add(12, output).bytes();
  }

 private:
  /// Adds one layer. Most kinds have an operator of the same meaning.
  std::string one(const Layer& layer, const std::string& in, std::size_t channels) {
    switch (layer.kind) {
      case LayerKind::linear:
        return linear(in);
      case LayerKind::conv:
        return conv(layer, in);
      case LayerKind::lstm:
      case LayerKind::gru:
        return recurrent(layer, in, channels);
      case LayerKind::layer_norm:
        return layer_norm(in);
      case LayerKind::relu:
        return node("Relu", {in});
      case LayerKind::leaky_relu:
        return node("LeakyRelu", {in}, {float_attribute("alpha", static_cast<float>(layer.slope))});
      case LayerKind::gelu:
        return gelu(in);
      case LayerKind::tanh:
        return node("Tanh", {in});
      case LayerKind::sigmoid:
        return node("Sigmoid", {in});
      case LayerKind::slice:
        return slice(in, integer(static_cast<std::int64_t>(layer.begin)),
                     integer(static_cast<std::int64_t>(layer.begin + layer.out)), 2);
      case LayerKind::max_pool:
        return max_pool(in);
      case LayerKind::sum:
      case LayerKind::product:
      case LayerKind::concat:
        return branches(layer, in, channels);
      case LayerKind::along_time:
        return along_time(layer, in);
      case LayerKind::dropout:
      case LayerKind::unpool:  // handled in list(), which knows the length
        break;
    }
    return in;
  }

  // ---- constants

  const Tensor& tensor(const std::string& what) const {
    return tensors_.at(prefix_ + path_ + "." + what);
  }

  /// Adds an initializer: a tensor that is stored in the file.
  std::string constant(const std::string& what, const Numbers& shape,
                       const std::vector<float>& values) {
    std::string name = path_ + "." + what;
    constants_.add(5, tensor_message(name, type_float, shape, bytes_of(values)));
    return name;
  }

  std::string stored(const std::string& what) {
    return constant(what, signed_shape(tensor(what).shape), tensor(what).values);
  }

  /// Numbers are constants too; a counter makes their names unique.
  std::string number(float value) {
    return constant("number_" + std::to_string(++values_), {}, {value});
  }

  /// Since opset 13 many operators take their sizes as inputs, so integers are constants.
  std::string integers(const Numbers& values) {
    std::string name = path_ + ".integers_" + std::to_string(++values_);
    constants_.add(5, tensor_message(name, type_int64, {static_cast<std::int64_t>(values.size())},
                                     bytes_of(values)));
    return name;
  }
  std::string integer(std::int64_t value) { return integers({value}); }

  // ---- layers

  std::string transposed(const std::string& in, const Numbers& order) {
    return node("Transpose", {in}, {list_attribute("perm", order)});
  }

  /// `begin` and `end` are names of values, because the end may depend on the number of frames.
  std::string slice(const std::string& in, const std::string& begin, const std::string& end,
                    std::int64_t axis) {
    return node("Slice", {in, begin, end, integer(axis)});
  }

  /// Adds a linear layer as MatMul and Add, because ONNX wants the transposed weights.
  std::string linear(const std::string& in) {
    const Tensor& weight = tensor("weight");
    const std::size_t rows = weight.shape[0], columns = weight.shape[1];
    std::vector<float> turned(weight.values.size());
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < columns; ++c) {
        turned[c * rows + r] = weight.values[r * columns + c];
      }
    }
    const auto product =
        node("MatMul", {in, constant("weight", signed_shape({columns, rows}), turned)});
    return node("Add", {product, stored("bias")});
  }

  /// ONNX has channels before frames, [1,C,T], so the values are transposed before and after.
  std::string conv(const Layer& layer, const std::string& in) {
    const auto reach = static_cast<std::int64_t>((layer.kernel - 1) * layer.dilation);
    const std::int64_t before = layer.causal ? reach : reach / 2;
    const auto out =
        node("Conv", {transposed(in, {0, 2, 1}), stored("weight"), stored("bias")},
             {list_attribute("dilations", {static_cast<std::int64_t>(layer.dilation)}),
              list_attribute("kernel_shape", {static_cast<std::int64_t>(layer.kernel)}),
              list_attribute("pads", {before, reach - before})});
    return transposed(out, {0, 2, 1});
  }

  /// Reorders the gates: PyTorch's order is i f g o for lstm and r z n for gru; ONNX has i o f g
  /// and z r n.
  std::string recurrent(const Layer& layer, const std::string& in, std::size_t channels) {
    const bool lstm = layer.kind == LayerKind::lstm;
    const std::vector<std::size_t> order =
        lstm ? std::vector<std::size_t>{0, 3, 1, 2} : std::vector<std::size_t>{1, 0, 2};
    const std::size_t rows = order.size() * layer.out, directions = layer.bidirectional ? 2 : 1;
    std::vector<float> from_input, from_state, bias;
    for (const std::string ending : {"_l0", "_l0_reverse"}) {
      if (ending != "_l0" && !layer.bidirectional) continue;
      append_gates(from_input, tensor("weight_ih" + ending), order);
      append_gates(from_state, tensor("weight_hh" + ending), order);
      append_gates(bias, tensor("bias_ih" + ending), order);
      append_gates(bias, tensor("bias_hh" + ending), order);
    }
    const Names inputs{
        transposed(in, {1, 0, 2}),
        constant("weight_ih", signed_shape({directions, rows, channels}), from_input),
        constant("weight_hh", signed_shape({directions, rows, layer.out}), from_state),
        constant("bias", signed_shape({directions, 2 * rows}), bias)};
    std::vector<ProtobufMessage> attributes{
        text_attribute("direction", layer.bidirectional ? "bidirectional" : "forward"),
        attribute("hidden_size", static_cast<std::int64_t>(layer.out))};
    // The reset gate acts after the product with the state, as in PyTorch. By default the reset
    // gate of ONNX acts before the product.
    if (!lstm) attributes.push_back(attribute("linear_before_reset", std::int64_t{1}));
    const auto out = node(lstm ? "LSTM" : "GRU", inputs, attributes);  // [T,directions,1,out]
    return node("Reshape", {transposed(out, {2, 0, 1, 3}), integers({0, 0, -1})});
  }

  /// Appends the gates of a tensor in another order. Each gate is a block of rows.
  static void append_gates(std::vector<float>& out, const Tensor& tensor,
                           const std::vector<std::size_t>& order) {
    const std::size_t size = tensor.values.size() / order.size();
    for (const std::size_t gate : order) {
      const auto from = tensor.values.begin() + static_cast<std::ptrdiff_t>(gate * size);
      out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(size));
    }
  }

  /// The mean over the channels.
  std::string mean(const std::string& in) {
    return node("ReduceMean", {in}, {list_attribute("axes", {2})});
  }

  /// Adds a layer_norm as mean, variance and scale, with the epsilon of PyTorch.
  std::string layer_norm(const std::string& in) {
    const auto centred = node("Sub", {in, mean(in)});
    const auto variance = mean(node("Mul", {centred, centred}));
    const auto deviation = node("Sqrt", {node("Add", {variance, number(1e-5F)})});
    const auto scaled = node("Mul", {node("Div", {centred, deviation}), stored("weight")});
    return node("Add", {scaled, stored("bias")});
  }

  /// Adds gelu in its exact form, x/2 (1 + erf(x/sqrt 2)).
  std::string gelu(const std::string& in) {
    const auto erf = node("Erf", {node("Mul", {in, number(std::sqrt(0.5F))})});
    const auto twice = node("Mul", {in, node("Add", {erf, number(1.0F)})});
    return node("Mul", {twice, number(0.5F)});
  }

  /// Adds a max_pool. The attribute ceil_mode keeps an odd last frame.
  std::string max_pool(const std::string& in) {
    const auto out = node("MaxPool", {transposed(in, {0, 2, 1})},
                          {attribute("ceil_mode", std::int64_t{1}),
                           list_attribute("kernel_shape", {2}), list_attribute("strides", {2})});
    return transposed(out, {0, 2, 1});
  }

  /// Repeats each frame, then cuts the result to the number of frames of `like`.
  std::string unpool(const std::string& in, const std::string& like, std::size_t channels) {
    const auto half = node("Mul", {in, number(0.5F)});
    const auto pairs = node("Concat", {half, half}, {attribute("axis", std::int64_t{2})});
    const auto twice =
        node("Reshape", {pairs, integers({0, -1, static_cast<std::int64_t>(channels)})});
    const auto frames = slice(node("Shape", {like}), integer(1), integer(2), 0);
    return slice(twice, integer(0), frames, 1);
  }

  /// Adds all branches on the same input, followed by Concat, Add or Mul.
  std::string branches(const Layer& layer, const std::string& in, std::size_t channels) {
    const std::string path = path_;
    Names results;
    for (std::size_t b = 0; b < layer.branches.size(); ++b) {
      results.push_back(list(layer.branches[b], in, channels, path_below(path, b)));
    }
    path_ = path;
    if (layer.kind == LayerKind::concat) {
      return node("Concat", results, {attribute("axis", std::int64_t{2})});
    }
    std::string out = results.front();
    for (std::size_t b = 1; b < results.size(); ++b) {
      out = node(layer.kind == LayerKind::sum ? "Add" : "Mul", {out, results[b]});
    }
    return out;
  }

  /// Adds an along_time. A convolution cuts the windows out: its tap k is 1 in channel k and 0 in
  /// all others. A transposed convolution adds the results at their frames. The channels become the
  /// batch, because each channel is processed alone.
  std::string along_time(const Layer& layer, const std::string& in) {
    const auto window = static_cast<std::int64_t>(layer.window);
    std::vector<float> taps(layer.window * layer.window, 0.0F);
    for (std::size_t k = 0; k < layer.window; ++k) taps[k * layer.window + k] = 1.0F;
    const auto cut = constant("window", {window, 1, window}, taps);
    const auto frames = slice(node("Shape", {in}), integer(1), integer(2), 0);
    const auto lacking = node("Max", {node("Sub", {integer(window), frames}), integer(0)});
    const auto pads = node("Concat", {integers({0, 0, 0, 0}), lacking, integer(0)},
                           {attribute("axis", std::int64_t{0})});
    const auto padded = node("Pad", {in, pads}, {text_attribute("mode", "edge")});
    const auto windows = node("Conv", {transposed(padded, {2, 0, 1}), cut});  // [C,window,W]
    const std::string path = path_;
    const auto rows = list(layer.branches.front(), transposed(windows, {0, 2, 1}), layer.window,
                           path_below(path, 0));
    path_ = path;
    const auto results = transposed(rows, {0, 2, 1});
    // The same transposed convolution over ones counts the windows of each frame.
    const auto ones = node("Add", {node("Mul", {windows, number(0.0F)}), number(1.0F)});
    const auto mean =
        node("Div", {node("ConvTranspose", {results, cut}), node("ConvTranspose", {ones, cut})});
    return slice(transposed(mean, {1, 2, 0}), integer(0), frames, 1);
  }

  const Tensors& tensors_;
  std::string prefix_;
  std::string path_;  // path of the layer that adds nodes
  std::size_t values_ = 0;
  ProtobufMessage graph_, constants_;
};

/// The name of the result's frame dimension. It is the input's name, unless a max_pool has no
/// unpool.
std::string frames_behind(const Architecture& architecture) {
  const auto& layers = architecture.layers;
  const auto count = [&layers](LayerKind kind) {
    return std::count_if(layers.begin(), layers.end(),
                         [kind](const Layer& layer) { return layer.kind == kind; });
  };
  return count(LayerKind::max_pool) == count(LayerKind::unpool) ? "T" : "pooled_T";
}

}  // namespace

Result<std::string> onnx_of(const Architecture& architecture, const Tensors& tensors,
                            const OnnxOptions& options) {
  KA_TRY(validate(architecture));
  KA_TRY(check_tensors(architecture, tensors, options.prefix));
  Graph graph(tensors, options.prefix);
  const auto result = graph.list(architecture.layers, options.input, architecture.inputs, "");
  // A last node gives the result the name that the caller wants; without layers there is no other
  // node.
  graph.node("Identity", {result}, {}, options.output);
  const auto bytes =
      graph.finish(value_info(options.input, "T", architecture.inputs),
                   value_info(options.output, frames_behind(architecture), outputs(architecture)));
  // ModelProto: ir_version 1, producer_name 2, graph 7, opset_import 8, metadata_props 14.
  ProtobufMessage model;
  model.add(1, ir_version).add(2, "kinalign").add(7, bytes);
  model.add(8, ProtobufMessage().add(1, "").add(2, opset));
  for (const auto& [key, value] : options.metadata) {
    model.add(14, ProtobufMessage().add(1, key).add(2, value));
  }
  return model.bytes();
}

}  // namespace kinalign
