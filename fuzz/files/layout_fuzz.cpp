// SPDX-License-Identifier: Apache-2.0
// A layout that is accepted can read a table without harm.
#include "fuzz/pieces.h"

#include "kinalign/formats/table/layout.h"
#include "kinalign/formats/table/table_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinalign;
  const auto layout = parse_layout(text_of(data, size), "fuzz");
  if (!layout) return 0;
  constexpr std::string_view table = "1 2,3;4\t5,6,7\nA_x,A_y,A_z\n1,2,3\n4,5,6\n";
  (void)matches(*layout, table);
  if (layout->kind == TableKind::points) {
    check_pieces([&] { return make_point_table_reader(*layout, {}, "f"); }, table);
  } else {
    check_pieces([&] { return make_imu_table_reader(*layout, {}, "f", ""); }, table);
  }
  return 0;
}
