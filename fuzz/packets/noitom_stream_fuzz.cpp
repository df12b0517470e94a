// SPDX-License-Identifier: Apache-2.0
// Frames do not depend on where the bytes are cut, few bytes wait, every byte is accounted for, and
// a frame that was read is sent and read again as the same. In datagrams few bytes wait, no byte is
// counted twice, and there are no more frames than the bytes have room for.
#include "tests/protocols/noitom/noitom_writer.h"

#include "kinalign/protocols/noitom/receiver.h"

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

/// Feeds the bytes as datagrams; their sizes and arrival times depend on the bytes.
void read_datagrams(std::span<const std::uint8_t> bytes) {
  NoitomReceiver receiver;
  std::vector<NoitomArrival> arrivals;
  const std::size_t size = bytes.size();
  HostTime now{};
  while (!bytes.empty()) {
    const std::size_t wish = bytes[0] % 2 == 0 ? 740 : 1 + 8UL * bytes[0];
    const auto part = bytes.first(std::min(wish, bytes.size()));
    receiver.feed_datagram(part, now, arrivals);
    now += std::chrono::milliseconds(part.back() % 8);
    bytes = bytes.subspan(part.size());
    if (receiver.waiting() > 20'480) std::abort();
  }
  receiver.finish(arrivals);
  const NoitomCounts& counts = receiver.counts();
  if (counts.frames != arrivals.size() || counts.bytes_skipped > size) std::abort();
  std::size_t in_frames = 0;
  for (const NoitomArrival& one : arrivals) {
    if (one.frame.form != NoitomForm::text) in_frames += 64 + 4 * one.frame.values.size();
  }
  if (in_frames + counts.bytes_skipped > size) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  read_datagrams(bytes);
  const Read whole = read(bytes, size + 1);
  const Read cut = read(bytes, 1 + size % 61);
  if (!(whole.counts == cut.counts) || whole.counts.bytes_skipped > size) std::abort();
  if (whole.arrivals.size() != cut.arrivals.size()) std::abort();
  for (std::size_t k = 0; k < whole.arrivals.size(); ++k) {
    const NoitomFrame& frame = whole.arrivals[k].frame;
    std::vector<std::uint8_t> sent, cut_sent, again;
    append_form_of_noitom(frame, sent);
    append_form_of_noitom(cut.arrivals[k].frame, cut_sent);
    if (sent != cut_sent) std::abort();
    const Read second = read(sent, sent.size());
    if (second.arrivals.size() != 1) std::abort();
    append_form_of_noitom(second.arrivals[0].frame, again);
    if (again != sent) std::abort();
  }
  return 0;
}
