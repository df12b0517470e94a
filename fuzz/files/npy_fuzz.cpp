// SPDX-License-Identifier: Apache-2.0
// An array that is accepted has the bytes that its header promises, and each value can be read.
#include "kinalign/numpy/npy.h"

#include <cstdint>
#include <cstdlib>

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto array = read_npy({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!array) return 0;
  const std::uint64_t values = array->header.values();
  if (values * array->header.value_bytes != array->bytes.size()) std::abort();
  for (std::size_t i = 0; i < values; ++i) {
    if (array->header.kind == 'U') {
      (void)text_at(*array, i);
    } else {
      (void)number_at(*array, i);
    }
  }
  return 0;
}
