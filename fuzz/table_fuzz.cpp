// SPDX-License-Identifier: Apache-2.0
// Every layout that the program carries, on any bytes.
// Seeds: kinect_keraal/G3*.txt kinect_laban/*.csv kinect_multitrack/*.csv imu_pose/unsw_walk/*.csv
#include "fuzz/pieces.h"

#include "kinalign/io/table_reader.h"

#include <vector>

namespace {

const std::vector<kinalign::TableLayout>& layouts() {
  static const auto all = [] {
    std::vector<kinalign::TableLayout> parsed;
    for (const auto name : kinalign::builtin_layout_names()) {
      parsed.push_back(*kinalign::parse_layout(*kinalign::builtin_layout(name), name));
    }
    return parsed;
  }();
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinalign;
  const std::string_view text = text_of(data, size);
  std::size_t chosen = size % layouts().size();
  for (std::size_t i = 0; i < layouts().size(); ++i) {
    if (matches(layouts()[i], text.substr(0, 4096))) chosen = i;
  }
  const TableLayout& layout = layouts()[chosen];
  if (layout.kind == TableKind::points) {
    check_pieces([&] { return make_point_table_reader(layout, {}, "f"); }, text);
  } else {
    check_pieces([&] { return make_imu_table_reader(layout, {}, "f", ""); }, text);
  }
  return 0;
}
