// SPDX-License-Identifier: Apache-2.0
// Frames do not depend on where bytes are cut, little waits, every byte is accounted for, and what
// was read is sent and read again as the same.
#include "kinalign/io/noitom_stream.h"

#include <cstdlib>

using namespace kinalign;

namespace {

struct Read {
  std::vector<NoitomArrival> arrivals;
  NoitomCounts counts;
};

Read read(std::span<const std::uint8_t> bytes, std::size_t piece) {
  NoitomDecoder decoder;
  Read all;
  while (!bytes.empty()) {
    const auto part = bytes.first(std::min(piece, bytes.size()));
    decoder.feed(part, all.arrivals);
    bytes = bytes.subspan(part.size());
    if (decoder.waiting() > 20'480) std::abort();
  }
  all.counts = decoder.counts();
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const Read whole = read(bytes, size + 1);
  const Read cut = read(bytes, 1 + size % 61);
  if (!(whole.counts == cut.counts) || whole.counts.bytes_skipped > size) std::abort();
  if (whole.arrivals.size() != cut.arrivals.size()) std::abort();
  for (std::size_t k = 0; k < whole.arrivals.size(); ++k) {
    const NoitomFrame& frame = whole.arrivals[k].frame;
    std::vector<std::uint8_t> sent, cut_sent, again;
    if (!append_noitom(frame, sent) || !append_noitom(cut.arrivals[k].frame, cut_sent))
      std::abort();
    if (sent != cut_sent) std::abort();
    const Read second = read(sent, sent.size());
    if (second.arrivals.size() != 1) std::abort();
    if (!append_noitom(second.arrivals[0].frame, again) || again != sent) std::abort();
  }
  return 0;
}
