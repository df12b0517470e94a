// SPDX-License-Identifier: Apache-2.0
// Seeds: imu_opensim/xsens/*.txt
#include "fuzz/pieces.h"

#include "kinalign/formats/imu/xsens_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinalign;
  const std::string_view text = text_of(data, size);
  (void)looks_like_xsens_text(text);
  check_pieces([] { return make_xsens_text_reader({}, "f", ""); }, text);
  return 0;
}
