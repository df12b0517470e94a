// SPDX-License-Identifier: Apache-2.0
// Tensors that are accepted are written and read again to the same bytes; so is the architecture
// that the metadata may hold.
#include "kinalign/infer/architecture_json.h"
#include "kinalign/infer/safetensors.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto first = read_safetensors({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!first) return 0;
  const std::string bytes = write_safetensors(*first);
  const auto second = read_safetensors(bytes, "again");
  if (!second || write_safetensors(*second) != bytes) std::abort();
  const auto found = first->metadata.find("architecture");
  if (found == first->metadata.end()) return 0;
  const auto network = parse_architecture_json(found->second, "fuzz");
  if (!network) return 0;
  const auto again = parse_architecture_json(architecture_json(*network), "again");
  if (!again || !(*again == *network)) std::abort();
  return 0;
}
