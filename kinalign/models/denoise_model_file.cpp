// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/model_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

using Json = ModelHeader;

// Limits of docs/formats/model.md. A model may come from anywhere, so a broken file must neither
// allocate without bound nor make the arithmetic overflow.
constexpr std::size_t most_joints = 1000, most_window = 1001;
constexpr double least_rate_hz = 0.1, most_rate_hz = 10'000.0;
constexpr double least_scale = 1e-6, most_scale = 1e6;

Json smoothing_json(const Smoothing& how) {
  return {{"window", how.window}, {"order", how.order}, {"causal", how.causal}};
}

/// The model's own part of the file's JSON header.
Json header_of(const DenoiseModel& model) {
  const DenoiseLayout& layout = model.layout;
  return {{"rate_hz", layout.rate_hz},
          {"input", {{"joints", layout.inputs}, {"smoothing", smoothing_json(layout.smoothing)}}},
          {"output",
           {{"joints", layout.outputs},
            {"parents", layout.parents},
            {"bases", layout.bases},
            {"scale_m", model.answer_scale},
            {"spread", model.states_spread},
            {"spread_factor", model.spread_factor}}},
          {"steadying",
           {{"mirror", model.steadying.mirror},
            {"smoothing", smoothing_json(model.steadying.smoothing)},
            {"bones", model.steadying.bones}}}};
}

/// Reads members of the header. A member of another type throws; read_denoise_model() turns that
/// into an Error.
Smoothing smoothing_of(const Json& json) {
  return {json.at("window").get<std::size_t>(), json.at("order").get<std::size_t>(),
          json.at("causal").get<bool>()};
}

/// Reads the header into the model. Throws where a member is missing or of another type.
void read_header(const Json& header, DenoiseModel& out) {
  out.facts = facts_of(header);
  DenoiseLayout& layout = out.layout;
  layout.rate_hz = header.at("rate_hz").get<double>();
  layout.inputs = header.at("input").at("joints").get<std::vector<std::string>>();
  layout.smoothing = smoothing_of(header.at("input").at("smoothing"));
  const Json& output = header.at("output");
  layout.outputs = output.at("joints").get<std::vector<std::string>>();
  layout.parents = output.at("parents").get<std::vector<int>>();
  layout.bases = output.at("bases").get<std::vector<int>>();
  out.answer_scale = output.at("scale_m").get<double>();
  out.states_spread = output.at("spread").get<bool>();
  out.spread_factor = output.value("spread_factor", 1.0);
  const Json& steadying = header.at("steadying");
  out.steadying = {steadying.at("mirror").get<bool>(), smoothing_of(steadying.at("smoothing")),
                   steadying.at("bones").get<bool>()};
}

bool in_range(const std::vector<int>& values, std::size_t end) {
  for (const int value : values) {
    if (value < -1 || value >= static_cast<int>(end)) return false;
  }
  return true;
}

bool is_sound(const Smoothing& how) {
  return how.window <= most_window && (how.window == 0 || how.window % 2 == 1) && how.order <= 5;
}

bool is_within(double value, double least, double most) { return value >= least && value <= most; }

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](float value) { return std::isfinite(value); });
}

/// Joints are found by name, so each name must be unique.
bool are_unique(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return std::adjacent_find(names.begin(), names.end()) == names.end();
}

/// True if the parents contain no cycle.
/// A walk up that takes more steps than there are joints has met a joint twice.
bool is_forest(const std::vector<int>& parents) {
  for (std::size_t j = 0; j < parents.size(); ++j) {
    int at = parents[j];
    for (std::size_t steps = 0; at >= 0; at = parents[static_cast<std::size_t>(at)]) {
      if (++steps > parents.size()) return false;
    }
  }
  return true;
}

/// Names the first part of the layout that is not valid; empty if all are valid.
std::string misfit(const DenoiseLayout& layout) {
  const std::size_t in = layout.inputs.size(), out = layout.outputs.size();
  if (in == 0 || out == 0 || in > most_joints || out > most_joints) return "number of joints";
  if (!are_unique(layout.inputs) || !are_unique(layout.outputs)) return "a joint twice";
  if (!body_joints(layout.inputs)) return "input without a root or both hips";
  if (layout.parents.size() != out || !in_range(layout.parents, out)) return "parents";
  if (!is_forest(layout.parents)) return "parents in a circle";
  if (layout.bases.size() != out || !in_range(layout.bases, in)) return "bases";
  if (!is_within(layout.rate_hz, least_rate_hz, most_rate_hz)) return "rate_hz";
  return is_sound(layout.smoothing) ? "" : "smoothing";
}

/// Names the first part of the model that is not valid; empty if all are valid.
std::string misfit(const DenoiseModel& model) {
  const DenoiseLayout& layout = model.layout;
  std::string fault = misfit(layout);
  if (!fault.empty()) return fault;
  if (!is_within(model.answer_scale, least_scale, most_scale)) return "scale_m";
  if (!is_within(model.spread_factor, least_scale, most_scale)) return "spread_factor";
  if (!is_sound(model.steadying.smoothing)) return "smoothing";
  if (model.input_mean.size() != layout.channels()) return "input.mean";
  if (model.input_scale.size() != layout.channels()) return "input.scale";
  if (model.answer_mean.size() != layout.answers()) return "answer.mean";
  const bool scales =
      std::all_of(model.input_scale.begin(), model.input_scale.end(),
                  [](float value) { return is_within(value, least_scale, most_scale); });
  if (!scales) return "input.scale";
  if (!all_finite(model.input_mean)) return "input.mean";
  if (!all_finite(model.answer_mean)) return "answer.mean";
  return "";
}

}  // namespace

// The scales are separate tensors in the file. read_denoise_model() takes them out again, so
// that only the networks' tensors remain.
std::string write_denoise_model(const DenoiseModel& model) {
  std::map<std::string, Architecture> networks{{"net", model.architecture}};
  if (model.second) networks["second"] = *model.second;
  std::map<std::string, Tensor> tensors = model.tensors;
  tensors["input.mean"] = row_of(model.input_mean);
  tensors["input.scale"] = row_of(model.input_scale);
  tensors["answer.mean"] = row_of(model.answer_mean);
  return write_model_file(model.facts, header_of(model), networks, std::move(tensors));
}

Result<DenoiseModel> read_denoise_model(std::string_view bytes, const std::string& name) {
  TensorFile file = KA_TRY(read_safetensors(bytes, name));
  const Json header = KA_TRY(read_model_header(file, name));
  // The task is checked before the other members. A model for poses then gives a clear message
  // instead of one about a missing member.
  if (const Json task = header.value("task", Json()); task.is_string() && task != "denoise") {
    return Failure(
        Error{name, 0, "a model that cleans skeletons", "task " + shown(task.get<std::string>())});
  }
  DenoiseModel out;
  try {
    read_header(header, out);
    out.architecture = KA_TRY(network_of(header, "net", name));
    if (header.at("networks").contains("second")) {
      out.second = KA_TRY(network_of(header, "second", name));
    }
  } catch (const nlohmann::json::exception& fault) {
    return broken_header(name, fault);
  }
  out.input_mean = KA_TRY(take_row(file.tensors, "input.mean", name));
  out.input_scale = KA_TRY(take_row(file.tensors, "input.scale", name));
  out.answer_mean = KA_TRY(take_row(file.tensors, "answer.mean", name));
  // Names and shapes of these tensors are checked by Network::make(), when the model is used.
  out.tensors = std::move(file.tensors);
  const std::string fault = misfit(out);
  if (!fault.empty()) return Failure(Error{name, 0, "parts that fit together", fault});
  return out;
}

}  // namespace kinalign
