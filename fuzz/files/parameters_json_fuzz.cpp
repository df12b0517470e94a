// SPDX-License-Identifier: Apache-2.0
// Parameters that are accepted are written and read again to the same text.
#include "kinalign/documents/parameters_json.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto first = parse_parameters_json({reinterpret_cast<const char*>(data), size});
  if (!first) return 0;
  const std::string json = parameters_json(*first);
  const auto second = parse_parameters_json(json);
  if (!second || parameters_json(*second) != json) std::abort();
  return 0;
}
