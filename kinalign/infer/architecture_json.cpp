// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/architecture_json.h"

#include "kinalign/core/find_named.h"
#include "kinalign/infer/layer_kinds.h"
#include "kinalign/infer/shapes.h"
#include "kinalign/infer/strict_json.h"

#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::json;

// ---- to JSON

// Keys keep the order of struct Layer, so the same network gives the same text.
nlohmann::ordered_json layers_to_json(const std::vector<Layer>& layers);

/// A layer as JSON, with only the members that its kind uses.
nlohmann::ordered_json layer_to_json(const Layer& layer) {
  nlohmann::ordered_json out;
  out["kind"] = row_of(layer.kind).name;
  if (uses(layer.kind, member_out)) out["out"] = layer.out;
  if (uses(layer.kind, member_kernel)) out["kernel"] = layer.kernel;
  if (uses(layer.kind, member_dilation)) out["dilation"] = layer.dilation;
  if (uses(layer.kind, member_causal)) out["causal"] = layer.causal;
  if (uses(layer.kind, member_bidirectional)) out["bidirectional"] = layer.bidirectional;
  if (uses(layer.kind, member_slope)) out["slope"] = layer.slope;
  if (uses(layer.kind, member_rate)) out["rate"] = layer.rate;
  if (uses(layer.kind, member_begin)) out["begin"] = layer.begin;
  if (uses(layer.kind, member_window)) out["window"] = layer.window;
  if (uses(layer.kind, member_branches)) {
    out["branches"] = nlohmann::ordered_json::array();
    for (const auto& branch : layer.branches) out["branches"].push_back(layers_to_json(branch));
  }
  return out;
}

nlohmann::ordered_json layers_to_json(const std::vector<Layer>& layers) {
  auto out = nlohmann::ordered_json::array();
  for (const Layer& layer : layers) out.push_back(layer_to_json(layer));
  return out;
}

// ---- from JSON; `at` names the layer, for messages

Failure wrong(const std::string& at, const std::string& expected, const std::string& found) {
  return Failure(Error{"", 0, expected + " in " + at, found});
}

Failure wrong_type(const std::string& at, const std::string& expected, const Json& found) {
  return wrong(at, expected, std::string("a JSON ") + found.type_name());
}

/// A member of Layer that is not a list, with its name in JSON.
template <class Value>
struct Named {
  const char* name;
  LayerMember member;
  Value Layer::*value;
};
// Members of one type are read by one piece of code; only their names differ.
constexpr Named<std::size_t> count_members[] = {{"out", member_out, &Layer::out},
                                                {"kernel", member_kernel, &Layer::kernel},
                                                {"dilation", member_dilation, &Layer::dilation},
                                                {"begin", member_begin, &Layer::begin},
                                                {"window", member_window, &Layer::window}};
constexpr Named<bool> truth_members[] = {
    {"causal", member_causal, &Layer::causal},
    {"bidirectional", member_bidirectional, &Layer::bidirectional}};
constexpr Named<double> number_members[] = {{"slope", member_slope, &Layer::slope},
                                            {"rate", member_rate, &Layer::rate}};

/// The row of `key` if the kind of `layer` uses it, else null.
template <class Value, std::size_t n>
const Named<Value>* used(const Named<Value> (&rows)[n], const Layer& layer,
                         const std::string& key) {
  for (const Named<Value>& row : rows) {
    if (key == row.name && uses(layer.kind, row.member)) return &row;
  }
  return nullptr;
}

// Negative numbers and fractions are refused: the JSON library marks only whole numbers from 0 on
// as unsigned.
Result<std::size_t> count_of(const Json& json, const std::string& key, const std::string& at) {
  if (json.is_number_unsigned()) return json.get<std::size_t>();
  return wrong_type(at, "a whole number as " + key, json);
}

/// Reads layers and counts them, so that a hostile text is refused early.
/// The recursion needs no limit here, because strict_json.h limits the depth of the text.
class Reader {
 public:
  /// Reads a list of layers. `path` names the layer that holds the list in messages.
  Result<std::vector<Layer>> layers(const Json& json, const std::string& path) {
    const std::string at = path.empty() ? "the network" : "layer " + path;
    if (!json.is_array()) return wrong_type(at, "an array of layers", json);
    std::vector<Layer> out;
    for (std::size_t i = 0; i < json.size(); ++i) {
      if (++count_ > most_layers) {
        return wrong(at, "at most " + std::to_string(most_layers) + " layers", "more");
      }
      out.push_back(KA_TRY(layer(json[i], path_below(path, i))));
    }
    return out;
  }

 private:
  /// Reads one layer, and fails if a member that its kind needs is missing.
  Result<Layer> layer(const Json& json, const std::string& path) {
    const std::string at = "layer " + path;
    if (!json.is_object()) return wrong_type(at, "a JSON object", json);
    if (!json.contains("kind") || !json["kind"].is_string()) return wrong(at, "a kind", "none");
    const auto kind = json["kind"].get<std::string>();
    const KindRow* const row = find_named(kind_rows, kind);
    if (row == nullptr) return wrong(at, "a known kind of layer", "\"" + shown(kind) + "\"");
    Layer out;
    out.kind = row->kind;
    for (const auto& [key, value] : json.items()) {
      if (key != "kind") KA_TRY(member(out, key, value, path));
    }
    // These members have no sensible default.
    if (uses(out.kind, member_out) && !json.contains("out")) return wrong(at, "out", "none");
    if (uses(out.kind, member_window) && !json.contains("window"))
      return wrong(at, "window", "none");
    if (uses(out.kind, member_branches) && !json.contains("branches")) {
      return wrong(at, "branches", "none");
    }
    return out;
  }

  /// Reads one member of a layer. A member that the kind does not use is refused, so that a
  /// spelling mistake does not become a default.
  Result<void> member(Layer& layer, const std::string& key, const Json& json,
                      const std::string& path) {
    const std::string at = "layer " + path;
    if (const auto* count = used(count_members, layer, key)) {
      layer.*count->value = KA_TRY(count_of(json, key, at));
    } else if (const auto* truth = used(truth_members, layer, key)) {
      if (!json.is_boolean()) return wrong_type(at, "true or false as " + key, json);
      layer.*truth->value = json.get<bool>();
    } else if (const auto* number = used(number_members, layer, key)) {
      if (!json.is_number()) return wrong_type(at, "a number as " + key, json);
      layer.*number->value = json.get<double>();
    } else if (key == "branches" && uses(layer.kind, member_branches)) {
      layer.branches = KA_TRY(branches(json, path));
    } else {
      return wrong(at, "members of " + std::string(row_of(layer.kind).name),
                   "\"" + shown(key) + "\"");
    }
    return {};
  }

  /// Reads the branches of a layer, each a list of layers.
  Result<std::vector<std::vector<Layer>>> branches(const Json& json, const std::string& path) {
    const std::string at = "layer " + path;
    if (!json.is_array()) return wrong_type(at, "an array of branches", json);
    // An empty branch has no layer, so branches are limited separately.
    if (json.size() > most_layers) {
      return wrong(at, "at most " + std::to_string(most_layers) + " branches",
                   std::to_string(json.size()));
    }
    std::vector<std::vector<Layer>> out;
    for (std::size_t b = 0; b < json.size(); ++b) {
      out.push_back(KA_TRY(layers(json[b], path_below(path, b))));
    }
    return out;
  }

  /// Number of layers read so far, in all branches.
  std::size_t count_ = 0;
};

Result<Architecture> architecture_of(const Json& json) {
  if (!json.is_object()) return wrong_type("the text", "a network as JSON object", json);
  Architecture out;
  for (const auto& [key, value] : json.items()) {
    if (key == "inputs") {
      out.inputs = KA_TRY(count_of(value, key, "the network"));
    } else if (key == "layers") {
      out.layers = KA_TRY(Reader{}.layers(value, ""));
    } else {
      return wrong("the network", "inputs and layers", "\"" + shown(key) + "\"");
    }
  }
  if (!json.contains("layers")) return wrong("the network", "layers", "none");
  KA_TRY(validate(out));
  return out;
}

}  // namespace

std::string architecture_json(const Architecture& architecture) {
  nlohmann::ordered_json out;
  out["inputs"] = architecture.inputs;
  out["layers"] = layers_to_json(architecture.layers);
  return out.dump();
}

Result<Architecture> parse_architecture_json(std::string_view text, const std::string& name) {
  auto out = architecture_of(KA_TRY(parse_strict_json(text, name)));
  if (!out) out.error().file = name;
  return out;
}

}  // namespace kinalign
