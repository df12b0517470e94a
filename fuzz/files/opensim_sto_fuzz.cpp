// SPDX-License-Identifier: Apache-2.0
// Seeds: imu_opensim/opensense/*.sto
#include "fuzz/pieces.h"

#include "kinalign/formats/imu/opensim_sto.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinalign;
  const std::string_view text = text_of(data, size);
  (void)looks_like_opensim_sto(text);
  check_pieces([] { return make_opensim_sto_reader({}, "f"); }, text);
  return 0;
}
