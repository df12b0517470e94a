// SPDX-License-Identifier: Apache-2.0
// Runs the network of a SafeTensors file for tests/infer/network_check.py:
//   run_network offline|online baseline|best MODEL IN OUT
// IN: float32 [T,inputs], OUT: float32 [T,outputs]. The architecture is JSON in the file's
// metadata.
#include "tests/folder.h"

#include "kinalign/infer/architecture_json.h"
#include "kinalign/infer/network.h"
#include "kinalign/infer/online.h"
#include "kinalign/infer/onnx.h"

#include <algorithm>
#include <cstdio>

using namespace kinalign;

namespace {

Result<void> run(const std::string& how, const Kernels& kernels, const std::string& model,
                 const std::string& in_path, const std::string& out_path) {
  const TensorFile file = KA_TRY(read_safetensors(bytes_in(model), model));
  if (how == "copy") {
    std::ofstream(out_path, std::ios::binary) << write_safetensors(file);
    return {};
  }
  const Architecture architecture =
      KA_TRY(parse_architecture_json(file.metadata.at("architecture"), model));
  if (how == "onnx") {
    OnnxOptions options;
    options.metadata["made by"] = "a test";
    std::ofstream(out_path, std::ios::binary)
        << KA_TRY(onnx_of(architecture, file.tensors, options));
    return {};
  }
  const Network network = KA_TRY(Network::make(architecture, file.tensors, "", kernels));
  const std::string bytes = bytes_in(in_path);
  std::vector<float> in(bytes.size() / sizeof(float));
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(in.data()));
  std::vector<float> out;
  if (how == "offline") {
    Workspace workspace;
    network.run(in, in.size() / network.inputs(), workspace, out);
  }
  if (how == "online") {
    OnlineNetwork online = KA_TRY(OnlineNetwork::make(network));
    for (std::size_t at = 0; at < in.size(); at += network.inputs()) {
      const auto result = online.step(std::span(in).subspan(at, network.inputs()));
      out.insert(out.end(), result.begin(), result.end());
    }
  }
  std::ofstream(out_path, std::ios::binary)
      .write(reinterpret_cast<const char*>(out.data()),
             static_cast<std::streamsize>(out.size() * sizeof(float)));
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const std::string how = argv[1], kernels = argv[2];
  const auto done = run(how, kernels == "baseline" ? baseline_kernels() : best_kernels(), argv[3],
                        argv[4], argv[5]);
  if (done) return 0;
  std::fprintf(stderr, "%s\n", to_string(done.error()).c_str());
  return 3;
}
