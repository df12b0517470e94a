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

using ModelHeader = nlohmann::ordered_json;

/// Members of the header that every model has stand around `own`, the task's.
std::string write_model_file(const ModelFacts& facts, const ModelHeader& own,
                             const std::map<std::string, Architecture>& networks,
                             std::map<std::string, Tensor> tensors);

/// The whole header. Fails where the file is no model of kinalign.
Result<ModelHeader> read_model_header(const TensorFile& file, const std::string& name);

/// The task of a model, "denoise" or "pose": which reader it needs. Fails as read_model_header().
Result<std::string> task_of_model(std::string_view bytes, const std::string& name);

/// Throws the JSON library's exception where a member is missing or of another type; the reader of
/// each task catches it and calls broken_header().
ModelFacts facts_of(const ModelHeader& header);
Failure broken_header(const std::string& name, const std::exception& fault);

/// The architecture `key` of the member "networks".
Result<Architecture> network_of(const ModelHeader& header, const std::string& key,
                                const std::string& name);

/// Takes the tensor `key` out of `tensors`, as a row of numbers.
Result<std::vector<float>> take_row(std::map<std::string, Tensor>& tensors, const std::string& key,
                                    const std::string& name);
Tensor row_of(const std::vector<float>& values);

/// Tensors whose names begin with `prefix`, without it.
std::map<std::string, Tensor> tensors_below(const std::map<std::string, Tensor>& tensors,
                                            const std::string& prefix);

}  // namespace kinalign
