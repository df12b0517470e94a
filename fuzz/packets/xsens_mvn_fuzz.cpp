// SPDX-License-Identifier: Apache-2.0
// Samples do not depend on where the bytes are cut, few bytes wait, and a sample that was read is
// sent and read again as the same. Poses and nodes made of the samples hold only finite numbers.
#include "fuzz/pieces.h"
#include "tests/protocols/xsens/xsens_datagrams.h"

#include "kinalign/protocols/xsens/stream.h"
#include "kinalign/recording/streams/xsens_pose.h"

#include <cstdlib>

using namespace kinalign;

namespace {

struct Decoded {
  std::vector<XsensArrival> arrivals;
  XsensCounts counts;
};

Decoded decode(std::span<const std::uint8_t> bytes, std::size_t piece) {
  XsensDecoder decoder;
  Decoded all;
  while (!bytes.empty()) {
    const auto part = bytes.first(std::min(piece, bytes.size()));
    decoder.feed(part, all.arrivals);
    bytes = bytes.subspan(part.size());
    if (decoder.waiting() > 70'000) std::abort();
  }
  all.counts = decoder.counts();
  return all;
}

std::vector<std::uint8_t> sent(const XsensSample& sample) {
  std::vector<std::uint8_t> bytes;
  for (const auto& datagram : xsens_datagrams(sample, {})) {
    bytes.insert(bytes.end(), datagram.begin(), datagram.end());
  }
  return bytes;
}

void check_numbers(const std::vector<XsensArrival>& arrivals) {
  XsensPoser poser("fuzz");
  XsensNodes nodes("fuzz");
  ClipFrames frames;
  ImuSamples samples;
  for (const auto& arrival : arrivals) {
    if (const auto* pose = std::get_if<XsensPose>(&arrival.sample.body)) {
      static_cast<void>(poser.append(*pose, Time{}, frames));
    } else if (const auto* trackers = std::get_if<XsensTrackers>(&arrival.sample.body)) {
      static_cast<void>(nodes.append(*trackers, Time{}, samples));
    }
  }
  for (const double x : frames.local_positions) {
    if (x - x != 0.0) std::abort();
  }
  for (const double x : frames.local_rotations) {
    if (x - x != 0.0) std::abort();
  }
  if (!sound(samples)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const Decoded whole = decode(bytes, size + 1);
  const Decoded cut = decode(bytes, 1 + size % 61);
  if (!(whole.counts == cut.counts) || whole.counts.bytes_skipped > size) std::abort();
  if (whole.arrivals.size() != cut.arrivals.size()) std::abort();
  for (std::size_t k = 0; k < whole.arrivals.size(); ++k) {
    const auto once = sent(whole.arrivals[k].sample);
    if (once != sent(cut.arrivals[k].sample)) std::abort();
    const Decoded second = decode(once, once.size());
    // A header's marker among the numbers would tear the datagram; only a made-up datagram has one.
    if (second.counts[XsensRefusal::torn] != 0) continue;
    if (second.arrivals.size() != 1 || sent(second.arrivals[0].sample) != once) std::abort();
  }
  check_numbers(whole.arrivals);
  return 0;
}
