// SPDX-License-Identifier: Apache-2.0
// Offsets, a line "%%", angles; a text without that line is both.
// Seeds: ui_prmd/original/Kinect/*/*.txt
#include "fuzz/pieces.h"
#include "fuzz/two_parts.h"

#include "kinalign/formats/points/ui_prmd_kinect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinalign;
  const TwoParts parts = two_parts(text_of(data, size));
  const std::string_view offsets = parts.first;
  const std::string_view angles = parts.divided ? parts.second : parts.first;
  (void)looks_like_ui_prmd_kinect(offsets);
  const auto make = [&] {
    return make_ui_prmd_kinect_reader(
        {}, "p", "a", [angles, at = std::size_t{0}, piece = 1 + size % 97]() mutable {
          const auto part = angles.substr(std::min(at, angles.size()), piece);
          at += part.size();
          return Result<std::string_view>(part);
        });
  };
  check_pieces(make, offsets);
  return 0;
}
