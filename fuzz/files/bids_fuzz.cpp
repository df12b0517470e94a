// SPDX-License-Identifier: Apache-2.0
// channels.tsv, a line "%%", then motion.tsv: rows do not depend on the pieces.
#include "fuzz/pieces.h"
#include "fuzz/two_parts.h"

#include "kinalign/formats/bids/system.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinalign;
  const TwoParts parts = two_parts(text_of(data, size));
  const auto channels = channels_of(read_tsv(parts.first), "channels.tsv");
  if (!channels) return 0;
  BidsSystem system;
  system.channels = *channels;
  system.rate_hz = 50.0;
  system.letters = {{"global", "ALS"}, {"left", "ARS"}};
  if (make_bids_point_reader(system, {}, "f")) {
    check_pieces([&] { return *make_bids_point_reader(system, {}, "f"); }, parts.second);
  }
  if (make_bids_node_reader(system, {}, "f")) {
    check_pieces([&] { return *make_bids_node_reader(system, {}, "f"); }, parts.second);
  }
  return 0;
}
