// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs/describe_model.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/text/counts_text.h"

#include "kinalign/infer/architecture_json.h"
#include "kinalign/infer/layer_kinds.h"
#include "kinalign/infer/shapes.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/fuse/fuse_model.h"
#include "kinalign/models/model_file.h"
#include "kinalign/models/pose/pose_model.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

// An ordered object prints its members in the order in which they are added, so the same model
// always gives the same bytes.
using Json = nlohmann::ordered_json;

/// The number of trained values of a network.
std::size_t parameters_of(const Architecture& architecture) {
  std::size_t sum = 0;
  for (const Parameter& parameter : parameters(architecture)) {
    std::size_t size = 1;
    for (const std::size_t length : parameter.shape) size *= length;
    sum += size;
  }
  return sum;
}

/// A layer of a network in words: "conv 128, kernel 5, dilation 2, causal".
std::string layer_text(const Layer& layer) {
  const LayerKind kind = layer.kind;
  // A table states which members each kind of layer uses. The other members have defaults and are
  // not shown.
  std::string text(row_of(kind).name);
  if (uses(kind, member_out)) text += fmt::format(" {}", layer.out);
  if (uses(kind, member_kernel)) text += fmt::format(", kernel {}", layer.kernel);
  if (layer.dilation > 1) text += fmt::format(", dilation {}", layer.dilation);
  if (layer.causal) text += ", causal";
  if (layer.bidirectional) text += ", both directions";
  if (uses(kind, member_slope)) text += fmt::format(" {:g}", layer.slope);
  if (uses(kind, member_rate)) text += fmt::format(" {:g}", layer.rate);
  if (uses(kind, member_begin)) text += fmt::format(" from {}", layer.begin);
  return text;
}

/// The layers of a network, one on each line. A layer may join the outputs of several branches,
/// which are themselves networks; they are indented below the layer. An empty branch does not
/// change its input.
std::string layer_lines(const std::vector<Layer>& layers, std::size_t indent) {
  std::string text;
  for (const Layer& layer : layers) {
    text += std::string(indent, ' ') + layer_text(layer) + "\n";
    for (const auto& branch : layer.branches) {
      text += std::string(indent + 2, ' ') +
              (branch.empty() ? "branch: unchanged input\n" : "branch\n");
      text += layer_lines(branch, indent + 4);
    }
  }
  return text;
}

/// The number of frames that a network uses in one direction. Empty means all frames, as for a
/// recurrent layer.
std::string frames_text(const std::optional<std::size_t>& frames, std::string_view way) {
  return frames ? fmt::format("{} {}", *frames, way) : fmt::format("all {}", way);
}

/// A network in words: "net: 147 in, 84 out, 166,228 parameters; a frame sees 17 before and 17
/// after it".
std::string network_lines(const std::string& name, const Architecture& architecture) {
  // These numbers decide whether the model can run live: each frame after the current one delays
  // the output.
  const std::string about =
      fmt::format("{}: {} in, {} out, {}; a frame sees {} and {} it", name, architecture.inputs,
                  outputs(architecture), counted(parameters_of(architecture), "parameter"),
                  frames_text(look_back(architecture), "before"),
                  frames_text(look_ahead(architecture), "after"));
  return fact_line("network", about) + layer_lines(architecture.layers, 14);
}

/// The same number in JSON. null means all frames; 0 means that no other frame is used.
Json frames_json(const std::optional<std::size_t>& frames) {
  return frames ? Json(*frames) : Json();
}

/// The smoothing of the output in words. A window of 0 or 1 frames does not smooth.
std::string smoothing_text(const Smoothing& how) {
  if (how.window < 2) return "no smoothing";
  return fmt::format("smoothed over {} frames (order {}{})", how.window, how.order,
                     how.causal ? ", causal" : "");
}

/// A list of names. A model's file may contain any text as a name, so shown() removes control
/// characters.
std::string name_list(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + shown(name);
  return out;
}

std::string joint_lines(std::string_view name, const std::vector<std::string>& joints) {
  return fact_line(name, fmt::format("{}: {}", counted(joints.size(), "joint"), name_list(joints)));
}

/// The member `key` as text on one line. Empty if the member is no text, since any program may have
/// written the object.
std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) return "";
  // A line end within the text would break the columns.
  std::string text = found->get<std::string>();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// The member `key` as a number. Empty if the member is no number, since any program may have
/// written the object.
std::string number_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? fmt::format("{:g}", found->get<double>())
                                                     : "";
}

/// The lines about the data sets with which a model was trained. A missing licence is stated,
/// because it limits the use of the model.
std::string data_lines(const Json& data) {
  std::string text;
  // `data` should be an array of objects. Anything else is skipped, so that the model can still be
  // described.
  for (const Json& one : data.is_array() ? data : Json::array()) {
    if (!one.is_object()) continue;
    std::string about = text_of(one, "name");
    if (const auto frames = number_of(one, "frames"); !frames.empty())
      about += ", " + frames + " frames";
    const std::string licence = text_of(one, "licence"), citation = text_of(one, "citation");
    about += licence.empty() ? ", no licence stated" : ", licence " + licence;
    text += fact_line("trained on", about);
    if (!citation.empty()) text += fact_line("  cite", citation);
  }
  return text;
}

/// The lines about a training and, if it continued the training of another model, about that model.
std::string training_lines(const Json& training) {
  std::string text = data_lines(training.value("data", Json::array()));
  std::string how;
  for (const char* key : {"steps", "rate", "seed"}) {
    const std::string value = number_of(training, key);
    if (!value.empty()) how += fmt::format("{}{} {}", how.empty() ? "" : ", ", key, value);
  }
  if (!how.empty()) text += fact_line("training", how);
  // The training continued from another model if "from" is set. The licences of that model's data
  // apply, too, so they are listed.
  const auto from = training.find("from");
  if (from == training.end() || !from->is_object()) return text;
  return text + fact_line("continued", "from a model of the same method") +
         data_lines(from->value("data", Json::array()));
}

/// One line for each metric. Metrics may have any form, so their JSON is printed.
std::string metric_lines(const Json& metrics) {
  std::string text;
  for (const auto& [name, value] : metrics.items()) {
    text += fact_line("metric", fmt::format("{} {}", shown(name), shown(value.dump())));
  }
  return text;
}

/// Parses a JSON object. Damaged text or another kind of value gives {}.
Json parsed_object(const std::string& text) {
  Json out = Json::parse(text, nullptr, false);
  return out.is_object() ? out : Json::object();
}

Json network_json(const Architecture& architecture) {
  Json out = Json::parse(architecture_json(architecture));
  out["outputs"] = outputs(architecture);
  out["parameters"] = parameters_of(architecture);
  out["look_back"] = frames_json(look_back(architecture));
  out["look_ahead"] = frames_json(look_ahead(architecture));
  return out;
}

Json smoothing_json(const Smoothing& how) {
  return {{"window", how.window}, {"order", how.order}, {"causal", how.causal}};
}

/// The height of a body at rest, m, from its lowest joint to its highest. At rest all rotations are
/// the identity, so the height of a joint is the sum of the offsets along y.
double height_at_rest(const Skeleton& skeleton) {
  std::vector<double> heights;
  for (std::size_t j = 0; j < skeleton.joints(); ++j) {
    // A parent stands before its children, so its height is already known here.
    const int parent = skeleton.parents[j];
    heights.push_back(parent < 0 ? 0.0
                                 : heights[static_cast<std::size_t>(parent)] +
                                       skeleton.rest_offsets[j].y());
  }
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  return *high - *low;
}

/// The name of the inputs in the file format (docs/formats/model.md).
std::string_view channels_name(PoseInputs inputs) {
  return inputs == PoseInputs::dip ? "dip" : "ours";
}

std::string model_line(const ModelFacts& facts) {
  return fact_line("model", fmt::format("{}, method {}", shown(facts.task), shown(facts.method)));
}

/// The lines about the output, the body and the network of a model for poses or fusion.
std::string body_lines(const PoseBody& body, bool smoothing, const Architecture& network) {
  return fact_line("output", fmt::format("rotations of {}", counted(body.bones.size(), "bone"))) +
         fact_line("body", fmt::format("{}, {:.2f} m from the lowest to the highest at rest",
                                       counted(body.skeleton.joints(), "joint"),
                                       height_at_rest(body.skeleton))) +
         network_lines("net", network) +
         fact_line("smoothing", smoothing ? "over 5 frames" : "none");
}

std::string model_text(const PoseModel& model) {
  const PoseLayout& layout = model.layout;
  std::string text = model_line(model.facts);
  text += fact_line("rate", fmt::format("{:g} Hz", layout.rate_hz));
  text +=
      fact_line("input", fmt::format("{}: {}; {} channels ({})",
                                     counted(layout.nodes.size(), "node"), name_list(layout.nodes),
                                     layout.channels(), channels_name(layout.inputs)));
  return text + body_lines(model.body, model.smoothing, model.architecture);
}

std::string model_text(const FuseModel& model) {
  const FuseLayout& layout = model.layout;
  std::string text = model_line(model.facts);
  text += fact_line("rate", fmt::format("{:g} Hz", layout.nodes.rate_hz));
  text += joint_lines("kinect", layout.joints);
  text += fact_line("nodes", fmt::format("{}: {}", counted(layout.nodes.nodes.size(), "node"),
                                         name_list(layout.nodes.nodes)));
  return text + body_lines(model.body, model.smoothing, model.architecture);
}

Json body_json(const PoseBody& body, bool smoothing) {
  return {{"bones", body.bones},
          {"joints", body.skeleton.joint_names},
          {"parents", body.skeleton.parents},
          {"height_m", height_at_rest(body.skeleton)},
          {"smoothing", smoothing}};
}

Json model_json(const PoseModel& model) {
  const PoseLayout& layout = model.layout;
  return {{"rate_hz", layout.rate_hz},
          {"input", {{"nodes", layout.nodes}, {"channels", channels_name(layout.inputs)}}},
          {"output", body_json(model.body, model.smoothing)},
          {"networks", {{"net", network_json(model.architecture)}}}};
}

Json model_json(const FuseModel& model) {
  const FuseLayout& layout = model.layout;
  return {{"rate_hz", layout.nodes.rate_hz},
          {"input", {{"nodes", layout.nodes.nodes}, {"joints", layout.joints}}},
          {"output", body_json(model.body, model.smoothing)},
          {"networks", {{"net", network_json(model.architecture)}}}};
}

/// The text about a model that cleans the joints of a Kinect.
std::string model_text(const DenoiseModel& model) {
  std::string text = model_line(model.facts);
  text += fact_line("rate", fmt::format("{:g} Hz", model.layout.rate_hz));
  text += joint_lines("input", model.layout.inputs);
  text += joint_lines("output", model.layout.outputs);
  text += fact_line("spread", model.states_spread ? "stated for each joint" : "not stated");
  text += network_lines("net", model.architecture);
  if (model.second) text += network_lines("second", *model.second);
  const Steadying& steadying = model.steadying;
  return text +
         fact_line("steadying", fmt::format("{}{}{}", smoothing_text(steadying.smoothing),
                                            steadying.mirror ? ", mean with the mirror image" : "",
                                            steadying.bones ? ", bones of constant length" : ""));
}

/// The JSON about a model that cleans the joints of a Kinect.
Json model_json(const DenoiseModel& model) {
  Json networks{{"net", network_json(model.architecture)}};
  if (model.second) networks["second"] = network_json(*model.second);
  return {
      {"rate_hz", model.layout.rate_hz},
      {"input",
       {{"joints", model.layout.inputs}, {"smoothing", smoothing_json(model.layout.smoothing)}}},
      {"output",
       {{"joints", model.layout.outputs},
        {"parents", model.layout.parents},
        {"spread", model.states_spread}}},
      {"networks", std::move(networks)},
      {"steadying",
       {{"mirror", model.steadying.mirror},
        {"smoothing", smoothing_json(model.steadying.smoothing)},
        {"bones", model.steadying.bones}}}};
}

/// The JSON members that every model has.
Json facts_json(const std::string& path, std::string_view bytes, const ModelFacts& facts) {
  return {{"file", path},       {"kind", "model"},        {"bytes", bytes.size()},
          {"task", facts.task}, {"method", facts.method}, {"software", facts.software}};
}

/// Describes a model as text and as JSON. `text` and `members` are the parts that depend on the
/// model's task. They stand between the facts and the training.
Description described(const std::string& path, std::string_view bytes, const ModelFacts& facts,
                      const std::string& text, const Json& members) {
  const Json training = parsed_object(facts.training), metrics = parsed_object(facts.metrics);
  Json json = facts_json(path, bytes, facts);
  // update() appends new members, so the members that every model has come first.
  json.update(members);
  json.update({{"training", training}, {"metrics", metrics}});
  return {path + "\n" + text + training_lines(training) + metric_lines(metrics), json_text(json)};
}

/// Reads and describes a model, then builds it as its verb would. Fails if the model can't be
/// built, even if it could be described.
template <class Solver>
Result<Description> described_by(auto read, const std::string& path, std::string_view bytes) {
  auto model = KA_TRY(read(bytes, path));
  Description out = described(path, bytes, model.facts, model_text(model), model_json(model));
  // make() takes the model, so the description is made before.
  KA_TRY(Solver::make(std::move(model)).map_error(in_file(path)));
  return out;
}

}  // namespace

Result<Description> describe_model(const std::string& path, std::string_view bytes) {
  // The task of the model decides which function reads it. A model with any other task is read as
  // one that cleans skeletons.
  const std::string task = KA_TRY(task_of_model(bytes, path));
  if (task == "pose") return described_by<PoseSolver>(read_pose_model, path, bytes);
  if (task == "fuse") return described_by<Fuser>(read_fuse_model, path, bytes);
  return described_by<Denoiser>(read_denoise_model, path, bytes);
}

}  // namespace kinalign
