// SPDX-License-Identifier: Apache-2.0
// Rows of segments and of sensors do not depend on the pieces.
// Seeds: bvh/*.mvnx.gz
#include "fuzz/pieces.h"

#include "kinalign/formats/mvnx/mvnx.h"

#include <algorithm>

using namespace kinalign;

namespace {

void check_clip(std::string_view text) {
  const std::size_t piece = 1 + text.size() % 61;
  const auto whole = read_all(make_mvnx_reader({}, "f"), text);
  const auto cut = read_in_pieces(make_mvnx_reader({}, "f"), text, piece);
  if (whole.error != cut.error) std::abort();
  if (whole.rows.stamps != cut.rows.stamps) std::abort();
  if (whole.rows.local_positions != cut.rows.local_positions) std::abort();
  if (whole.rows.local_rotations != cut.rows.local_rotations) std::abort();
  const auto finite = [](double x) { return x - x == 0.0; };
  const auto& places = whole.rows.local_positions;
  if (!std::all_of(places.begin(), places.end(), finite)) std::abort();
  const auto& stamps = whole.rows.stamps;
  if (!std::is_sorted(stamps.begin(), stamps.end())) std::abort();
  if (whole.has_header && !validate(whole.header)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = text_of(data, size);
  (void)looks_like_mvnx(text);
  check_clip(text);
  check_pieces([] { return make_mvnx_sensor_reader({}, "f"); }, text);
  return 0;
}
