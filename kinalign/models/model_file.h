// SPDX-License-Identifier: Apache-2.0
// Parts that the files of all models share: SafeTensors with a header that describes the model.
// Layout: docs/formats/model.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/architecture.h"
#include "kinalign/infer/safetensors.h"
#include "kinalign/models/model_facts.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Members keep their order, so that the same model gives the same bytes.
using ModelHeader = nlohmann::ordered_json;

/// The bytes of a model's file. `own`: header members of the task, written between those that every
/// model has.
std::string write_model_file(const ModelFacts& facts, const ModelHeader& own,
                             const std::map<std::string, Architecture>& networks,
                             std::map<std::string, Tensor> tensors);

/// The whole header. Fails if the file is not a model of kinalign.
Result<ModelHeader> read_model_header(const TensorFile& file, const std::string& name);

/// The task of a model, for example "denoise" or "pose"; it decides which reader is needed. Fails
/// like read_model_header().
Result<std::string> task_of_model(std::string_view bytes, const std::string& name);

/// Reads the facts. Throws the JSON library's exception if a member is missing or of another type;
/// the reader of each task catches it and calls broken_header().
ModelFacts facts_of(const ModelHeader& header);
Failure broken_header(const std::string& name, const std::exception& fault);

/// The architecture `key` of the member "networks".
Result<Architecture> network_of(const ModelHeader& header, const std::string& key,
                                const std::string& name);

/// Removes the tensor `key` from `tensors` and returns its values.
/// Readers take the scales out in this way; the tensors that remain belong to networks.
Result<std::vector<float>> take_row(std::map<std::string, Tensor>& tensors, const std::string& key,
                                    const std::string& name);
Tensor row_of(const std::vector<float>& values);

/// Tensors whose names begin with `prefix`; the prefix is removed from their names.
std::map<std::string, Tensor> tensors_below(const std::map<std::string, Tensor>& tensors,
                                            const std::string& prefix);

}  // namespace kinalign
