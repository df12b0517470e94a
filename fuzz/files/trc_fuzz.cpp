// SPDX-License-Identifier: Apache-2.0
// Seeds: points_trc/*.trc
#include "fuzz/pieces.h"

#include "kinalign/formats/points/trc.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinalign;
  const std::string_view text = text_of(data, size);
  (void)looks_like_trc(text);
  check_pieces([] { return make_trc_reader({}, "f"); }, text);
  return 0;
}
