// SPDX-License-Identifier: Apache-2.0
// A model that is accepted is written and read again to the same bytes, and cleans two frames.
#include "kinalign/models/denoise_model.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto first = read_denoise_model({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!first) return 0;
  const std::string bytes = write_denoise_model(*first);
  const auto second = read_denoise_model(bytes, "again");
  if (!second || write_denoise_model(*second) != bytes) std::abort();
  auto denoiser = Denoiser::make(*std::move(first));
  if (!denoiser) return 0;
  const DenoiseLayout& layout = denoiser->model().layout;
  const JointFrames body{layout.inputs.size(), std::vector<float>(6 * layout.inputs.size(), 0.5F),
                         std::vector<std::uint8_t>(2 * layout.inputs.size(), 2)};
  const Denoised out = denoiser->clean(body);
  if (out.positions.size() != 2 * layout.answers()) std::abort();
  return 0;
}
