// SPDX-License-Identifier: Apache-2.0
#include "fuzz/pieces.h"

#include "kinalign/formats/points/ntu_skeleton.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinalign;
  const std::string_view text = text_of(data, size);
  (void)looks_like_ntu_skeleton(text);
  check_pieces([] { return make_ntu_skeleton_reader({}, "f"); }, text);
  return 0;
}
