// SPDX-License-Identifier: Apache-2.0
// Writes a model's answers for tests/learn/learn_check.py:
//   run_denoiser answer|clean MODEL IN OUT
// IN: float32 [T,J,3] m, all joints tracked; OUT: float32 [T,Jout,3] m.
#include "tests/folder.h"

#include "kinalign/models/denoise_model.h"

#include <cstdio>
#include <cstring>

using namespace kinalign;

namespace {

Result<void> run(const std::string& how, const std::string& model, const std::string& in,
                 const std::string& out) {
  Denoiser denoiser = KA_TRY(Denoiser::make(KA_TRY(read_denoise_model(bytes_in(model), model))));
  const std::string bytes = bytes_in(in);
  JointFrames body{denoiser.model().layout.inputs.size(), {}, {}};
  body.positions.resize(bytes.size() / sizeof(float));
  std::memcpy(body.positions.data(), bytes.data(), body.positions.size() * sizeof(float));
  body.seen.assign(body.positions.size() / 3, 2);
  const Denoised answer = how == "answer" ? denoiser.answer(body) : denoiser.clean(body);
  std::ofstream(out, std::ios::binary)
      .write(reinterpret_cast<const char*>(answer.positions.data()),
             static_cast<std::streamsize>(answer.positions.size() * sizeof(float)));
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const auto done = run(argv[1], argv[2], argv[3], argv[4]);
  if (done) return 0;
  std::fprintf(stderr, "%s\n", to_string(done.error()).c_str());
  return 3;
}
