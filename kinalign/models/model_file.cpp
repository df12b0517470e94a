// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/model_file.h"

#include "kinalign/infer/architecture_json.h"
#include "kinalign/infer/strict_json.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace kinalign {

namespace {

constexpr const char* header_key = "kinalign";
constexpr const char* model_schema = "kinalign.model/1";

/// Parses a JSON text; gives an empty object if the text is not valid.
ModelHeader object_of(const std::string& text) {
  ModelHeader out = ModelHeader::parse(text.empty() ? "{}" : text, nullptr, false);
  return out.is_discarded() ? ModelHeader::object() : out;
}

}  // namespace

std::string write_model_file(const ModelFacts& facts, const ModelHeader& own,
                             const std::map<std::string, Architecture>& networks,
                             std::map<std::string, Tensor> tensors) {
  ModelHeader header{{"schema", model_schema},
                     {"task", facts.task},
                     {"method", facts.method},
                     {"software", facts.software}};
  header.update(own);
  for (const auto& [key, architecture] : networks) {
    header["networks"][key] = ModelHeader::parse(architecture_json(architecture));
  }
  header["training"] = object_of(facts.training);
  header["metrics"] = object_of(facts.metrics);
  return write_safetensors({{{header_key, header.dump()}}, std::move(tensors)});
}

Result<ModelHeader> read_model_header(const TensorFile& file, const std::string& name) {
  const auto text = file.metadata.find(header_key);
  ModelHeader header;
  if (text != file.metadata.end()) {
    // This call only checks the text, because its result does not keep the order of the members.
    KA_TRY(parse_strict_json(text->second, name));
    header = ModelHeader::parse(text->second, nullptr, false);
  }
  const bool is_ours =
      header.is_object() && header.contains("schema") && header.at("schema") == model_schema;
  if (!is_ours) {
    return Failure(
        Error{name, 0, "a model of kinalign (schema kinalign.model/1)", "a file of another kind"});
  }
  return header;
}

Result<std::string> task_of_model(std::string_view bytes, const std::string& name) {
  const ModelHeader header = KA_TRY(read_model_header(KA_TRY(read_safetensors(bytes, name)), name));
  const auto task = header.find("task");
  return task != header.end() && task->is_string() ? task->get<std::string>() : std::string();
}

ModelFacts facts_of(const ModelHeader& header) {
  return {.task = header.at("task").get<std::string>(),
          .method = header.at("method").get<std::string>(),
          .software = header.value("software", ""),
          .training = header.value("training", ModelHeader::object()).dump(),
          .metrics = header.value("metrics", ModelHeader::object()).dump()};
}

Failure broken_header(const std::string& name, const std::exception& fault) {
  return Failure(Error{name, 0, "a complete header of a model", shown(fault.what())});
}

Result<Architecture> network_of(const ModelHeader& header, const std::string& key,
                                const std::string& name) {
  return parse_architecture_json(header.at("networks").at(key).dump(), name);
}

Result<std::vector<float>> take_row(std::map<std::string, Tensor>& tensors, const std::string& key,
                                    const std::string& name) {
  const auto found = tensors.find(key);
  if (found == tensors.end()) return Failure(Error{name, 0, "a tensor " + key, "none"});
  std::vector<float> out = std::move(found->second.values);
  tensors.erase(found);
  return out;
}

Tensor row_of(const std::vector<float>& values) { return {{values.size()}, values}; }

// A file holds the tensors of all its networks in one list; the prefix tells them apart.
std::map<std::string, Tensor> tensors_below(const std::map<std::string, Tensor>& tensors,
                                            const std::string& prefix) {
  std::map<std::string, Tensor> out;
  for (const auto& [name, tensor] : tensors) {
    if (name.starts_with(prefix)) out[name.substr(prefix.size())] = tensor;
  }
  return out;
}

}  // namespace kinalign
