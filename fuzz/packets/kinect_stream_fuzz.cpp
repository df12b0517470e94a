// SPDX-License-Identifier: Apache-2.0
// Messages of a Kinect's sender. An accepted datagram encodes again to the same bytes, and as a
// line to the same content. A connection's messages do not depend on where it is cut, and joining
// them ends. No fuzzer guesses a CRC, so with an odd first byte the CRCs of binary messages are
// repaired.
#include "tests/protocols/kinect/kinect_lines.h"

#include "kinalign/protocols/kinect/binary.h"
#include "kinalign/protocols/kinect/frames.h"
#include "kinalign/protocols/kinect/stream.h"
#include "kinalign/wire/crc32.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace kinalign;

namespace {

using Bytes = std::vector<std::uint8_t>;

void mend(Bytes& bytes) {
  for (std::size_t at = 0; at + 8 <= bytes.size();) {
    const std::span<std::uint8_t> rest = std::span(bytes).subspan(at);
    const std::size_t length = stated_kinect_length(rest);
    const bool whole = std::equal(kinect_magic.begin(), kinect_magic.end(), rest.begin()) &&
                       length >= 28 && length <= rest.size();
    if (!whole) {
      ++at;
      continue;
    }
    const std::uint32_t crc = crc32(rest.first(length - 4));
    for (std::size_t i = 0; i < 4; ++i) {
      rest[length - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
    }
    at += length;
  }
}

/// NaN in a line is null, whatever its bits were.
bool is_finite(const KinectMessage& message) {
  const auto finite = [](float x) { return std::isfinite(x); };
  const auto* frame = std::get_if<KinectFrame>(&message);
  if (frame == nullptr) return true;
  if (frame->floor && !std::all_of(frame->floor->begin(), frame->floor->end(), finite)) {
    return false;
  }
  return std::all_of(frame->bodies.begin(), frame->bodies.end(), [&](const KinectBody& body) {
    return std::all_of(body.positions.begin(), body.positions.end(), finite) &&
           std::all_of(body.orientations.begin(), body.orientations.end(), finite);
  });
}

void check_datagram(const Bytes& bytes) {
  KinectMessage message;
  if (decode_kinect_datagram(bytes, message) != KinectRefusal::none) return;
  const Bytes binary = encode_kinect_binary(message);
  if (bytes[0] == 'K' && binary != bytes) std::abort();
  const std::string line = encode_kinect_line(message);
  KinectMessage again;
  if (decode_kinect_line(line, again) != KinectRefusal::none) std::abort();
  if (encode_kinect_line(again) != line) std::abort();
  if (is_finite(message) && encode_kinect_binary(again) != binary) std::abort();
}

struct Heard {
  std::vector<KinectMessage> messages;
  KinectStreamCounts counts;
};

Heard hear(const Bytes& bytes, std::size_t piece) {
  KinectStreamDecoder decoder;
  Heard heard;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    decoder.feed(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)), heard.messages);
  }
  decoder.finish(heard.messages);
  heard.counts = decoder.counts();
  return heard;
}

void check_frames(const std::vector<KinectMessage>& messages) {
  KinectFrameJoiner joiner;
  std::vector<JoinedKinectFrame> frames;
  std::size_t given = 0, bodies = 0;
  for (const auto& message : messages) {
    const auto* frame = std::get_if<KinectFrame>(&message);
    if (frame == nullptr) continue;
    ++given;
    joiner.take(*frame, frames);
  }
  joiner.finish(frames);
  if (frames.size() > given) std::abort();
  PointFrames rows;
  for (const auto& joined : frames) {
    bodies += joined.frame.bodies.size();
    if (check(joined.frame) != KinectRefusal::none) std::abort();
    append_kinect_row(joined.frame, 1, rows);
  }
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::all_of(rows.positions.begin(), rows.positions.end(), finite)) std::abort();
  if (bodies > most_kinect_bodies * given || rows.state.size() != 25 * frames.size()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  Bytes bytes(data + 2, data + size);
  if (data[0] % 2 == 1) mend(bytes);
  check_datagram(bytes);
  const Heard whole = hear(bytes, std::max<std::size_t>(bytes.size(), 1));
  const Heard cut = hear(bytes, std::size_t{1} + data[1]);
  if (!(whole.counts == cut.counts) || whole.messages.size() != cut.messages.size()) std::abort();
  for (std::size_t i = 0; i < whole.messages.size(); ++i) {
    if (encode_kinect_binary(whole.messages[i]) != encode_kinect_binary(cut.messages[i])) {
      std::abort();
    }
  }
  check_frames(whole.messages);
  return 0;
}
