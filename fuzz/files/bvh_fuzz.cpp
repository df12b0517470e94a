// SPDX-License-Identifier: Apache-2.0
// Whatever is accepted is written and read again to the same text, and pieces cut anywhere give the
// same frames.
// Seeds: bvh/*.bvh bvh/edge/*.bvh
#include "kinalign/formats/bvh/bvh.h"

#include <cstdint>
#include <cstdlib>
#include <string>

using namespace kinalign;

namespace {

std::string written(const BvhFile& file) {
  std::string text;
  const auto sink = [&text](std::string_view piece) -> Result<void> {
    text += piece;
    return {};
  };
  if (!write_bvh(file, sink)) std::abort();
  return text;
}

bool same_in_pieces(std::string_view text, std::size_t piece, const ClipFrames& whole) {
  const auto reader = make_bvh_reader({}, "pieces");
  ClipFrames frames;
  for (std::size_t at = 0; at < text.size(); at += piece) {
    if (!reader->feed(text.substr(at, piece), frames)) return false;
  }
  return reader->finish(frames) && frames.local_positions == whole.local_positions &&
         frames.stamps == whole.stamps;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto first = read_bvh(text, "fuzz", {});
  if (!first) return 0;
  if (!same_in_pieces(text, 1 + size % 61, first->clip.frames)) std::abort();
  const std::string again = written(*first);
  const auto second = read_bvh(again, "again", {});
  if (!second || written(*second) != again) std::abort();
  return 0;
}
