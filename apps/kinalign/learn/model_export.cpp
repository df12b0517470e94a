// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/json_text.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/describe_model.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/infer/onnx.h"
#include "kinalign/infer/shapes.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/fuse/fuse_model.h"
#include "kinalign/models/model_file.h"
#include "kinalign/models/pose/pose_model.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// The options of `kinalign model export`.
struct Export {
  std::vector<std::string> model;
  std::string network = "net";
};

/// The command line of `kinalign model export`.
Usage describe_export(Export& o) {
  Usage usage;
  usage.positionals = {{"MODEL", "the model's file", &o.model}};
  usage.flags = {choice_flag("network", "network to export: net, or the second network of bra-p",
                             &o.network, {"net", "second"})};
  usage.check = [](const Common& common, const Sources&) -> Result<void> {
    return check_out(common, {".onnx"}, "-o FILE.onnx");
  };
  return usage;
}

/// A network and the tensors of its layers.
struct Parts {
  Architecture architecture;
  std::map<std::string, Tensor> tensors;
};

/// A linear map of each channel: y = factor x + offset. Such maps standardise a network's input and
/// scale its answer. They are exported as layers, so that the ONNX file is complete.
struct Scaling {
  std::vector<float> factor, offset;
};

/// Adds the tensors of a linear layer for the map: a diagonal matrix of weights [channels,
/// channels] and the offsets.
void put_scaling(const Scaling& scaling, const std::string& path,
                 std::map<std::string, Tensor>& out) {
  const std::size_t n = scaling.factor.size();
  Tensor weight{{n, n}, std::vector<float>(n * n, 0.0F)};
  for (std::size_t c = 0; c < n; ++c) weight.values[c * n + c] = scaling.factor[c];
  out[path + ".weight"] = std::move(weight);
  out[path + ".bias"] = {{n}, scaling.offset};
}

/// Adds the maps of input and output to a network, as its first and last layer.
Parts scaled(const Parts& network, const Scaling& before, const Scaling& after) {
  Parts out{network.architecture, {}};
  auto& layers = out.architecture.layers;
  // A new first layer is added, so the number of each layer in the tensors' names grows by one.
  layers.insert(layers.begin(), {.kind = LayerKind::linear, .out = before.factor.size()});
  layers.push_back({.kind = LayerKind::linear, .out = after.factor.size()});
  for (const auto& [name, tensor] : network.tensors) {  // "3.1.0.weight" becomes "4.1.0.weight"
    const std::size_t dot = name.find('.');
    out.tensors[std::to_string(std::stoul(name.substr(0, dot)) + 1) + name.substr(dot)] = tensor;
  }
  // Layer 0 is the new first layer. The last index is the new last layer.
  put_scaling(before, "0", out.tensors);
  put_scaling(after, std::to_string(layers.size() - 1), out.tensors);
  return out;
}

/// A network with only the tensors of its layers. A file may contain more tensors.
Parts parts_of(const Architecture& architecture, const std::map<std::string, Tensor>& tensors,
               const std::string& name) {
  Parts out{architecture, {}};
  for (const Parameter& parameter : parameters(architecture)) {
    out.tensors[parameter.name] = tensors.at(name + "." + parameter.name);
  }
  return out;
}

/// The map that gives channels mean 0 and deviation 1: (x - mean) / scale as factor and offset.
Scaling standardising(const std::vector<float>& mean, const std::vector<float>& scale) {
  Scaling out;
  for (std::size_t c = 0; c < mean.size(); ++c) {
    out.factor.push_back(1.0F / scale[c]);
    out.offset.push_back(-mean[c] / scale[c]);
  }
  return out;
}

/// A model's network, with its own map of the input and the given map of the output.
Parts scaled_network(const auto& model, const Scaling& after) {
  return scaled(parts_of(model.architecture, model.tensors, "net"),
                standardising(model.input_mean, model.input_scale), after);
}

/// The network of a model that cleans a Kinect. Its answers are corrections in metres and, in the
/// last channels, logarithms of deviations in centimetres. The logarithms are not scaled.
Parts whole_network(const DenoiseModel& model) {
  Scaling after;
  after.factor.assign(model.layout.answers(), static_cast<float>(model.answer_scale));
  after.offset = model.answer_mean;
  if (model.states_spread) {
    // After the three coordinates of all output joints follows one channel for each joint.
    after.factor.resize(after.factor.size() + model.layout.outputs.size(), 1.0F);
    after.offset.resize(after.factor.size(), 0.0F);
  }
  return scaled_network(model, after);
}

/// The map that adds the identity to the rotation of each bone, because networks answer the
/// difference from it. A rotation has six numbers: the first two columns of its matrix.
Scaling onto_identity(std::size_t bones) {
  Scaling out;
  out.factor.assign(6 * bones, 1.0F);
  for (std::size_t b = 0; b < bones; ++b) {
    // An answer of zeros therefore means the identity.
    out.offset.insert(out.offset.end(), six_of_identity.begin(), six_of_identity.end());
  }
  return out;
}

/// The metadata of the ONNX file: what each channel means, in words. `second`: for the second
/// network, which uses the first one's answer.
std::map<std::string, std::string> metadata_of(const DenoiseModel& model, bool second) {
  const DenoiseLayout& layout = model.layout;
  Json bases = Json::array();
  for (const int base : layout.bases) {
    // An output joint without a corresponding input joint has null.
    bases.push_back(base < 0 ? Json() : Json(layout.inputs[static_cast<std::size_t>(base)]));
  }
  std::string output = "positions of the output joints in the body's frame, m";
  // The input and the output of the second network are positions: it improves the answer of the
  // first one.
  if (!second) {
    output = "what is added to the smoothed base joint of each output joint, m";
    if (model.states_spread) output += "; then ln of each joint's standard deviation per axis, cm";
  }
  return {{"kinalign.task", model.facts.task},
          {"kinalign.method", model.facts.method},
          {"kinalign.rate_hz", fmt::format("{:g}", layout.rate_hz)},
          {"kinalign.input", second ? "positions of the output joints in the body's frame, m"
                                    : "positions of the input joints in the body's frame, m; their "
                                      "differences to the frame before; 1 tracked, 0.5 inferred, 0 "
                                      "missing"},
          {"kinalign.output", output},
          {"kinalign.input_joints", Json(layout.inputs).dump()},
          {"kinalign.output_joints", Json(layout.outputs).dump()},
          {"kinalign.bases", bases.dump()},
          {"kinalign.training", model.facts.training}};
}

/// The network that is exported, and its metadata.
struct Exported {
  Parts parts;
  std::map<std::string, std::string> metadata;
};

Result<Exported> exported_denoise(const std::string& bytes, const std::string& path, bool second) {
  const DenoiseModel model = KA_TRY(read_denoise_model(bytes, path));
  // The model is built once to check it. The result is not used.
  KA_TRY(Denoiser::make(model).map_error(in_file(path)));
  if (second && !model.second) {
    return Failure(Error{path, 0, "a second network", "none"});
  }
  Parts parts = second ? parts_of(*model.second, model.tensors, "second") : whole_network(model);
  return Exported{std::move(parts), metadata_of(model, second)};
}

/// The metadata of models for poses and fusion. The description of the channels is long, so the
/// metadata names the manual page.
std::map<std::string, std::string> body_metadata(const ModelFacts& facts, const PoseLayout& layout,
                                                 const std::string& output) {
  return {{"kinalign.task", facts.task},
          {"kinalign.method", facts.method},
          {"kinalign.rate_hz", fmt::format("{:g}", layout.rate_hz)},
          {"kinalign.input", "channels as described in docs/formats/model.md"},
          {"kinalign.output", output},
          {"kinalign.nodes", Json(layout.nodes).dump()},
          {"kinalign.bones", Json(layout.bones).dump()},
          {"kinalign.training", facts.training}};
}

/// The network of a model for poses. A model that kinalign can't use is refused before any file is
/// written.
Result<Exported> exported_pose(const std::string& bytes, const std::string& path) {
  const PoseModel model = KA_TRY(read_pose_model(bytes, path));
  KA_TRY(PoseSolver::make(model).map_error(in_file(path)));
  return Exported{scaled_network(model, onto_identity(model.layout.bones.size())),
                  body_metadata(model.facts, model.layout,
                                "two columns of each bone's rotation against the root, not yet "
                                "orthonormal")};
}

/// The network of a model for fusion. Its last three answers are the root's position, in units of
/// fuse_place_unit_m.
Result<Exported> exported_fuse(const std::string& bytes, const std::string& path) {
  const FuseModel model = KA_TRY(read_fuse_model(bytes, path));
  KA_TRY(Fuser::make(model).map_error(in_file(path)));
  // The rotation of the root follows those of the bones, so there is one rotation more.
  Scaling after = onto_identity(model.layout.nodes.bones.size() + 1);
  // resize() adds the three channels of the position, which have another factor.
  after.factor.resize(model.layout.answers(), fuse_place_unit_m);
  after.offset.resize(model.layout.answers(), 0.0F);
  Exported out{scaled_network(model, after),
               body_metadata(model.facts, model.layout.nodes,
                             "two columns of the rotation of each bone and of the root in the "
                             "frame's space, not yet orthonormal; the way from SpineBase to the "
                             "root, m")};
  out.metadata["kinalign.joints"] = Json(model.layout.joints).dump();
  return out;
}

/// Chooses the network by the model's task. Only a model that cleans a Kinect may have a second
/// network.
Result<Exported> exported(const std::string& bytes, const std::string& path,
                          const std::string& network) {
  const std::string task = KA_TRY(task_of_model(bytes, path));
  const bool second = network == "second";
  if (second && task != "denoise") {
    return Failure(Error{path, 0, "a second network", "none"});
  }
  if (task == "pose") return exported_pose(bytes, path);
  return task == "fuse" ? exported_fuse(bytes, path) : exported_denoise(bytes, path, second);
}

/// Writes the ONNX file and prints the numbers of its channels.
Result<int> run_export(Export& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string &in = o.model.front(), &out = call.common.out;
  KA_TRY(keep_inputs(out, o.model));
  const std::string bytes = KA_TRY(read_whole(files, in, most_model_bytes));
  const Exported whole = KA_TRY(exported(bytes, in, o.network));
  const Parts& parts = whole.parts;
  // The tensors have the names of this network's layers already, so no prefix is needed.
  const OnnxOptions options{.prefix = "", .metadata = whole.metadata};
  KA_TRY(write_whole(files, out, KA_TRY(onnx_of(parts.architecture, parts.tensors, options)),
                     call.common.overwrite()));
  call.console.wrote(out);
  const std::size_t channels = parts.architecture.inputs, answers = outputs(parts.architecture);
  call.console.print(fmt::format("{}: input [1,T,{}], output [1,T,{}], ONNX opset 13\n",
                                 harmless(out), channels, answers));
  call.console.print_json(
      json_text(Json{{"file", out}, {"inputs", channels}, {"outputs", answers}}));
  return 0;
}

}  // namespace

/// The verb `kinalign model export`.
Verb model_export_verb() {
  return make_verb<Export>(
      {.name = "model export",
       .summary = "write a model's network as ONNX",
       .text = "Writes the network for ONNX Runtime and similar programs. The graph contains the "
               "scales of its numbers. The metadata and docs/formats/model.md describe the "
               "channels. The graph does not compute the channels, nor does it smooth the answer "
               "or turn it into rotations.",
       .examples = {{"kinalign model export denoise.safetensors -o denoise.onnx",
                     "for ONNX Runtime"}},
       .common = {"out", "force", "json"}},
      describe_export, run_export);
}

}  // namespace kinalign
