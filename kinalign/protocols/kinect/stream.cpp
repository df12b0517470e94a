// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/stream.h"

#include "kinalign/protocols/kinect/binary.h"
#include "kinalign/protocols/kinect/lines.h"
#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>

namespace kinalign {

namespace {

using Refusal = KinectRefusal;

bool is_blank(std::uint8_t byte) {
  return byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
}

/// True if the bytes begin with the magic. If there are fewer bytes than the magic has, all of them
/// must agree with it.
bool may_be_magic(std::span<const std::uint8_t> bytes) {
  const auto front = bytes.first(std::min(bytes.size(), kinect_magic.size()));
  return std::equal(front.begin(), front.end(), kinect_magic.begin());
}

}  // namespace

// Each datagram may have its own encoding. The first byte shows whether it is a line or a binary
// message.
KinectRefusal decode_kinect_datagram(std::span<const std::uint8_t> datagram,
                                     KinectMessage& message) {
  message = {};
  if (datagram.empty()) return Refusal::too_short;
  if (datagram[0] == '{') return decode_kinect_line(text_of(datagram), message);
  return may_be_magic(datagram) ? decode_kinect_binary(datagram, message) : Refusal::no_message;
}

void KinectStreamDecoder::take(KinectRefusal refusal, KinectMessage& message,
                               std::vector<KinectMessage>& out) {
  if (refusal == Refusal::none) {
    ++counts_.messages;
    out.push_back(std::move(message));
  } else {
    ++counts_.refused[static_cast<std::size_t>(refusal)];
  }
}

/// The number of bytes before the next possible beginning of a message. Skipped bytes may be the
/// rest of a binary message, so a '{' among them begins a line only at the start of a line.
std::size_t KinectStreamDecoder::skip_to_start(std::span<const std::uint8_t> bytes) {
  std::size_t at = 0;
  while (at < bytes.size() && !may_be_magic(bytes.subspan(at))) {
    const bool blank = is_blank(bytes[at]);
    if (mode_ == Mode::unknown && bytes[at] == '{' && (!lost_ || skipped_ == '\n')) break;
    // A stretch of invalid bytes counts as one refusal. Blanks between lines are allowed.
    if (mode_ == Mode::binary || !blank) {
      if (!lost_) ++counts_.refused[static_cast<std::size_t>(Refusal::no_message)];
      lost_ = true;
      ++counts_.skipped_bytes;
    }
    skipped_ = bytes[at++];
  }
  return at;
}

/// Handles one binary message. Returns the number of bytes used; 0 if more bytes are needed. After
/// a wrong CRC the whole message is skipped, so that no byte is checked twice. The length is safe
/// to use, because it fits the head.
std::size_t KinectStreamDecoder::step_binary(std::span<const std::uint8_t> bytes,
                                             std::vector<KinectMessage>& out) {
  if (const std::size_t skipped = skip_to_start(bytes); skipped > 0) return skipped;
  if (bytes.size() < kinect_head_size) return 0;
  // If the head is impossible, the magic was part of other data. The search continues directly
  // after the magic.
  if (const Refusal refusal = check_kinect_head(bytes); refusal != Refusal::none) {
    ++counts_.refused[static_cast<std::size_t>(refusal)];
    counts_.skipped_bytes += kinect_magic.size();
    lost_ = true;
    return kinect_magic.size();
  }
  const std::size_t length = stated_kinect_length(bytes);
  if (bytes.size() < length) return 0;
  KinectMessage message;
  const Refusal refusal = decode_kinect_binary(bytes.first(length), message);
  lost_ = refusal == Refusal::bad_crc;
  if (lost_) counts_.skipped_bytes += length;
  take(refusal, message, out);
  return length;
}

/// Handles one line. Returns the number of bytes used; 0 if more bytes are needed.
std::size_t KinectStreamDecoder::step_line(std::span<const std::uint8_t> bytes,
                                           std::vector<KinectMessage>& out) {
  const auto end =
      std::find(bytes.begin() + static_cast<std::ptrdiff_t>(searched_), bytes.end(), '\n');
  const auto length = static_cast<std::size_t>(end - bytes.begin());
  // The line end has not arrived. A line beyond the limit is dropped piece by piece to limit the
  // memory, and counts as one refusal.
  if (end == bytes.end()) {
    searched_ = length;
    if (length <= most_kinect_line) return 0;
    if (!in_long_line_) ++counts_.refused[static_cast<std::size_t>(Refusal::too_long)];
    in_long_line_ = true;
    searched_ = 0;
    counts_.skipped_bytes += length;
    return length;
  }
  searched_ = 0;
  const auto line = text_of(bytes.first(length));
  if (in_long_line_) {
    in_long_line_ = false;
    counts_.skipped_bytes += length;
  } else if (length > most_kinect_line) {
    ++counts_.refused[static_cast<std::size_t>(Refusal::too_long)];
    counts_.skipped_bytes += length;
  } else if (line.find_first_not_of(" \t\r") != std::string_view::npos) {
    KinectMessage message;
    take(decode_kinect_line(line, message), message, out);
  }
  return length + 1;
}

/// Handles the next message. The first message decides whether the connection has lines or binary
/// messages.
std::size_t KinectStreamDecoder::step(std::span<const std::uint8_t> bytes,
                                      std::vector<KinectMessage>& out) {
  if (mode_ == Mode::lines) return step_line(bytes, out);
  if (mode_ == Mode::binary) return step_binary(bytes, out);
  if (const std::size_t skipped = skip_to_start(bytes); skipped > 0) return skipped;
  const bool line = bytes[0] == '{';
  if (!line && bytes.size() < kinect_magic.size()) return 0;
  mode_ = line ? Mode::lines : Mode::binary;
  lost_ = false;
  return step(bytes, out);
}

void KinectStreamDecoder::feed(std::span<const std::uint8_t> piece,
                               std::vector<KinectMessage>& out) {
  held_.insert(held_.end(), piece.begin(), piece.end());
  std::size_t at = 0;
  while (at < held_.size()) {
    const std::size_t done = step(std::span(held_).subspan(at), out);
    if (done == 0) break;
    at += done;
  }
  held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(at));
}

void KinectStreamDecoder::finish(std::vector<KinectMessage>& out) {
  // The last line may have no line end. An added line end is harmless, because an empty line is
  // ignored.
  if (mode_ == Mode::lines) {
    const std::uint8_t end = '\n';
    feed({&end, 1}, out);
    return;
  }
  if (!held_.empty()) ++counts_.refused[static_cast<std::size_t>(Refusal::too_short)];
  counts_.skipped_bytes += held_.size();
  held_.clear();
}

}  // namespace kinalign
