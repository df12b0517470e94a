// SPDX-License-Identifier: Apache-2.0
// A network as an ONNX file (github.com/onnx/onnx, opset 13), for ONNX Runtime and its like.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/architecture.h"
#include "kinalign/infer/safetensors.h"

#include <map>
#include <string>

namespace kinalign {

struct OnnxOptions {
  std::string input = "input";    // [1,T,inputs]
  std::string output = "output";  // [1,T,outputs]; T need not be named when the file is written
  std::string prefix;             // before the names of the tensors, as in Network::make
  std::map<std::string, std::string> metadata;
};

/// The same network gives the same bytes. Fails where Network::make does.
Result<std::string> onnx_of(const Architecture& architecture,
                            const std::map<std::string, Tensor>& tensors,
                            const OnnxOptions& options);

}  // namespace kinalign
