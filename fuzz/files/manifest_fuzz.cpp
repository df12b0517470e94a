// SPDX-License-Identifier: Apache-2.0
// A manifest that is accepted survives the way into a take's parameters and back; a lab that is
// accepted can be recorded.
#include "kinalign/documents/lab_toml.h"
#include "kinalign/documents/manifest_toml.h"
#include "kinalign/documents/parameters_json.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto devices = read_devices(text, "fuzz"); devices && !validate({*devices, {}})) {
    std::abort();
  }
  const auto manifest = read_manifest(text, "fuzz");
  if (!manifest) return 0;
  const std::string json = parameters_json(*manifest);
  const auto again = parse_parameters_json(json);
  if (!again || parameters_json(*again) != json) std::abort();
  return 0;
}
