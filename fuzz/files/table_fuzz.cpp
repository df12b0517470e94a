// SPDX-License-Identifier: Apache-2.0
// Every layout that the program carries, on any bytes; or a user's layout, a line "%%", a table.
// Seeds: kinect_keraal/G3*.txt kinect_laban/*.csv kinect_multitrack/*.csv imu_pose/unsw_walk/*.csv
#include "fuzz/pieces.h"
#include "fuzz/two_parts.h"

#include "kinalign/formats/table/table_reader.h"

#include <vector>

using namespace kinalign;

namespace {

const std::vector<TableLayout>& layouts() {
  static const auto all = [] {
    std::vector<TableLayout> parsed;
    for (const auto name : builtin_layout_names()) {
      parsed.push_back(*parse_layout(*builtin_layout(name), name));
    }
    return parsed;
  }();
  return all;
}

/// Options that a user may give for any table; the input's size selects them.
StreamOptions options_for(std::size_t size) {
  StreamOptions options;
  if (size % 3 == 1) options.rate_hz = 30.0;
  if (size % 5 == 1) options.start_ns = 1'000'000'007;
  if (size % 7 == 1) options.select = {{"1", "1"}};
  if (size % 7 == 2) options.select = {{"x", "1"}};
  if (size % 2 == 1) options.up = size % 4 == 1 ? "z" : "y";
  return options;
}

void check(const TableLayout& layout, const StreamOptions& options, std::string_view table) {
  if (layout.kind == TableKind::points) {
    check_pieces([&] { return make_point_table_reader(layout, options, "f"); }, table);
  } else {
    check_pieces([&] { return make_imu_table_reader(layout, options, "f", ""); }, table);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = text_of(data, size);
  const TwoParts parts = two_parts(text);
  if (const auto layout = parse_layout(parts.first, "fuzz"); parts.divided && layout) {
    (void)matches(*layout, parts.second.substr(0, 4096));
    check(*layout, options_for(size), parts.second);
    return 0;
  }
  std::size_t chosen = size % layouts().size();
  for (std::size_t i = 0; i < layouts().size(); ++i) {
    if (matches(layouts()[i], text.substr(0, 4096))) chosen = i;
  }
  check(layouts()[chosen], {}, text);
  return 0;
}
