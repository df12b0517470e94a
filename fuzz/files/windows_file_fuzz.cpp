// SPDX-License-Identifier: Apache-2.0
// In a file that is accepted, the pairs of any two streams are complete.
#include "kinalign/models/pairs.h"
#include "kinalign/models/windows_file.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

namespace {

void check(const Pairs& pairs) {
  for (const Pair& pair : pairs.all) {
    const std::size_t frames = pair.input.frames();
    const bool whole = pair.input.positions.size() == frames * pairs.inputs.size() * 3 &&
                       pair.truth.size() == frames * pairs.outputs.size() * 3 &&
                       pair.valid.size() == frames * pairs.outputs.size();
    if (!whole) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto windows = read_windows({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!windows || windows->facts.streams.size() > 8) return 0;
  for (const auto& input : windows->facts.streams) {
    for (const auto& truth : windows->facts.streams) {
      if (const auto pairs = pairs_of(*windows, input.name, truth.name, 1)) check(*pairs);
    }
  }
  return 0;
}
