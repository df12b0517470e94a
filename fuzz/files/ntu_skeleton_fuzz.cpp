// SPDX-License-Identifier: Apache-2.0
#include "fuzz/pieces.h"

#include "kinalign/formats/points/ntu_skeleton.h"

#include <utility>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinalign;
  const std::string_view text = text_of(data, size);
  (void)looks_like_ntu_skeleton(text);
  bool is_given = false;
  (void)ntu_bodies(
      [&]() -> Result<std::string_view> { return std::exchange(is_given, true) ? "" : text; }, "f");
  check_pieces([] { return make_ntu_skeleton_reader({}, "f"); }, text);
  return 0;
}
