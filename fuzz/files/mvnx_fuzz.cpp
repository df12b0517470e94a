// SPDX-License-Identifier: Apache-2.0
// Rows of segments and of sensors do not depend on the pieces in which a file is read. A file that
// fails must fail in any pieces, but its message may differ: Expat holds a token until it is whole,
// so an error of the archive after it may be reported first. Seeds: bvh/*.mvnx.gz
#include "fuzz/pieces.h"

#include "kinalign/formats/mvnx/mvnx.h"

#include <algorithm>

using namespace kinalign;

namespace {

bool is_finite(double x) { return x - x == 0.0; }

bool same_rows(const ClipFrames& a, const ClipFrames& b) {
  return a.stamps == b.stamps && a.local_positions == b.local_positions &&
         a.local_rotations == b.local_rotations;
}

bool is_good(const Skeleton& skeleton, const ClipFrames& rows) {
  return validate(skeleton).has_value() &&
         std::all_of(rows.local_positions.begin(), rows.local_positions.end(), is_finite) &&
         std::all_of(rows.local_rotations.begin(), rows.local_rotations.end(), is_finite) &&
         std::is_sorted(rows.stamps.begin(), rows.stamps.end());
}
bool is_good(const ImuHeader&, const ImuSamples& rows) { return sound(rows); }

template <class MakeReader>
void check(MakeReader make, std::string_view text) {
  const auto whole = read_all(make(), text);
  const auto cut = read_in_pieces(make(), text, 1 + text.size() % 61);
  if (whole.error.empty() != cut.error.empty()) std::abort();
  if (!whole.error.empty()) return;
  if (!whole.has_header || !is_good(whole.header, whole.rows)) std::abort();
  if (!same_rows(whole.rows, cut.rows)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = text_of(data, size);
  (void)looks_like_mvnx(text);
  check([] { return make_mvnx_reader({}, "f"); }, text);
  check([] { return make_mvnx_sensor_reader({}, "f"); }, text);
  return 0;
}
