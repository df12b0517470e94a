// SPDX-License-Identifier: Apache-2.0
// Writes a network as an ONNX file (github.com/onnx/onnx, opset 13), for ONNX Runtime and similar
// programs.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/architecture.h"
#include "kinalign/infer/safetensors.h"

#include <map>
#include <string>

namespace kinalign {

/// Names in the file. The batch has size 1; the number of frames is free.
struct OnnxOptions {
  std::string input = "input";    // [1,T,inputs]
  std::string output = "output";  // [1,T,outputs]; T is a free dimension of the file
  std::string prefix;             // prefix of the tensors' names, as in Network::make
  std::map<std::string, std::string> metadata;
};

/// The same network gives the same bytes. Fails in the cases in which Network::make fails.
Result<std::string> onnx_of(const Architecture& architecture,
                            const std::map<std::string, Tensor>& tensors,
                            const OnnxOptions& options);

}  // namespace kinalign
