// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/noitom/stream.h"

#include "kinalign/protocols/noitom/text.h"
#include "kinalign/wire/little_endian.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace kinalign {

namespace {

// The bytes that are handled at once. The buffer therefore contains at most one incomplete frame
// and one slice, even if the caller passes a long piece.
constexpr std::size_t slice = 4096;
// A frame in text form is shorter: it has at most 360 values of 40 characters, and a name.
constexpr std::size_t longest_text = 16'384;
constexpr std::size_t most_avatars = 64;
constexpr std::size_t zipped_head = 10;  // CCCC, a length, and 1F 8B, which begin a gzip
// The most values of a frame whose count is unknown to kinalign: 200 joints with displacement and a
// reference.
constexpr std::size_t most_values = 1206;

bool is_digit(std::uint8_t b) { return b >= '0' && b <= '9'; }
bool is_white(std::uint8_t b) { return b == ' ' || b == '\t' || b == '\r' || b == '\n'; }
bool may_stand_in_text(std::uint8_t b) {
  return is_white(b) || (b > ' ' && b != 0x7f && b != 0xff);
}

using Begins = bool (*)(std::span<const std::uint8_t> bytes);

/// Position of the first header in [from, end); `end` if there is none.
std::size_t header_within(std::span<const std::uint8_t> bytes, std::size_t from, std::size_t end,
                          Begins begins) {
  for (std::size_t at = from; at < end; ++at) {
    const void* found = std::memchr(&bytes[at], 0xff, end - at);
    if (found == nullptr) break;
    at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - bytes.data());
    if (begins(bytes.subspan(at))) return at;
  }
  return end;
}

// The values of a complete frame, 32-bit floats in little-endian order.
std::vector<float> values_of(std::span<const std::uint8_t> frame) {
  std::vector<float> values;
  values.reserve((frame.size() - noitom_header_size) / 4);
  for (std::size_t at = noitom_header_size; at < frame.size(); at += 4) {
    values.push_back(std::bit_cast<float>(little_at<std::uint32_t>(frame, at)));
  }
  return values;
}

}  // namespace

void NoitomDecoder::feed(std::span<const std::uint8_t> bytes, std::vector<NoitomArrival>& out) {
  while (!bytes.empty()) {
    const auto piece = bytes.first(std::min(slice, bytes.size()));
    bytes = bytes.subspan(piece.size());
    held_.insert(held_.end(), piece.begin(), piece.end());
    take_all(out);
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ = 0;
  }
}

void NoitomDecoder::take_all(std::vector<NoitomArrival>& out) {
  while (at_ < held_.size() && step(out) == Step::go_on) {
  }
}

// The bytes at the front will not be completed. They are skipped up to the next header, where a
// complete frame may begin.
void NoitomDecoder::give_up(std::vector<NoitomArrival>& out) {
  while (waiting() > 0) {
    if (begins_noitom_header(ahead())) count_incomplete();
    skip(header_within(ahead(), 1, waiting(), begins_noitom_header));
    take_all(out);
  }
  held_.clear();
  at_ = 0;
}

std::optional<NoitomBeginning> NoitomDecoder::beginning() const {
  const auto bytes = ahead();
  if (bytes.size() < noitom_header_size || !has_noitom_tokens(bytes)) return std::nullopt;
  const auto header = parse_noitom_header(bytes);
  if (!header || header->compressed) return std::nullopt;
  return NoitomBeginning{noitom_header_size + 4 * header->values, header->frame.avatar,
                         header->frame.frame_index};
}

bool NoitomDecoder::waits_within_header() const {
  return waiting() > 0 && waiting() < noitom_header_size && ahead()[0] == 0xff;
}

// Every move of the front resets searched_ and behind_text_, because they describe the bytes at the
// old front.
void NoitomDecoder::take(std::size_t bytes) {
  at_ += bytes;
  searched_ = 0;
  behind_text_ = false;
}

void NoitomDecoder::skip(std::size_t bytes) {
  take(bytes);
  counts_.bytes_skipped += bytes;
}

/// Handles the data at the front. Its first byte shows the form.
NoitomDecoder::Step NoitomDecoder::step(std::vector<NoitomArrival>& out) {
  const std::uint8_t first = ahead()[0];
  if (first == 0xff) return marked(out);
  if (first == 'C') return zipped();
  if (is_digit(first)) return text(out);
  if (behind_text_ && is_white(first)) {
    ++at_;
    return Step::go_on;
  }
  skip(1);
  return Step::go_on;
}

// Handles data that begin with FF. The next byte shows which of Noitom's three kinds of header it
// is.
NoitomDecoder::Step NoitomDecoder::marked(std::vector<NoitomArrival>& out) {
  const auto bytes = ahead();
  if (bytes.size() < 2) return Step::wait;
  if (bytes[1] == 0xdd) return binary(out);
  if (bytes[1] == 0x88) return other_header(0x99, NoitomRefusal::calculation);
  if (bytes[1] == 0xaa) return other_header(0xbb, NoitomRefusal::command);
  skip(1);
  return Step::go_on;
}

/// Handles a binary header and, when it is complete, the frame after it.
NoitomDecoder::Step NoitomDecoder::binary(std::vector<NoitomArrival>& out) {
  const auto bytes = ahead();
  if (bytes.size() < noitom_header_size) return Step::wait;
  if (!has_noitom_tokens(bytes)) {
    skip(1);
    return Step::go_on;
  }
  auto header = parse_noitom_header(bytes);
  if (!header) return misfit();
  if (header->compressed) {
    refuse(NoitomRefusal::compressed);
    take(noitom_header_size);
    return Step::go_on;
  }
  const std::size_t size = noitom_header_size + 4 * header->values;
  if (bytes.size() < size) return Step::wait;
  // If another header begins among the values, a piece of this frame was lost. The values before
  // that header may be wrong.
  const std::size_t next =
      header_within(bytes.first(size), noitom_header_size, size, begins_noitom_header);
  if (next < size) {
    count_incomplete();
    skip(next);
    return Step::go_on;
  }
  if (parts_ == NoitomParts::all) header->frame.values = values_of(bytes.first(size));
  take(size);
  give(std::move(header->frame), out);
  return Step::go_on;
}

// Counts the frame at the front as incomplete. Its header with its number has arrived, so the
// number does not count as lost. Unknown avatars are not counted, because the bytes may not be a
// header.
void NoitomDecoder::count_incomplete() {
  refuse(NoitomRefusal::incomplete);
  const auto head = beginning();
  if (!head || !head->index) return;
  const auto avatar = avatars_.find(head->avatar);
  if (avatar != avatars_.end()) avatar->second.by_index.push(*head->index);
}

// Handles a header whose count and flags fit no layout. If the next header follows after as many
// values as the count says, the data are a frame with an unknown count. If a header begins earlier,
// this header is dropped at once. Only complete headers are considered, so the result does not
// depend on cuts.
NoitomDecoder::Step NoitomDecoder::misfit() {
  const auto bytes = ahead();
  const std::size_t values = stated_noitom_values(bytes);
  const auto drop = [&](NoitomRefusal refusal, std::size_t dropped) {
    refuse(refusal);
    skip(dropped);
    return Step::go_on;
  };
  if (values == 0 || values > most_values) return drop(NoitomRefusal::garbage, 2);
  const std::size_t size = noitom_header_size + 4 * values;
  const std::size_t end = std::min(size, bytes.size() - noitom_header_size + 1);
  const std::size_t from = std::max<std::size_t>(searched_, 2);
  if (header_within(bytes, from, end, has_noitom_tokens) < end) {
    return drop(NoitomRefusal::garbage, 2);
  }
  if (bytes.size() < size + noitom_header_size) {
    searched_ = end;
    return Step::wait;
  }
  const bool is_frame = has_noitom_tokens(bytes.subspan(size));
  return is_frame ? drop(NoitomRefusal::wrong_count, size) : drop(NoitomRefusal::garbage, 2);
}

// Handles a header of 64 bytes that ends in FF and `last_byte`. The bytes after it are skipped one
// by one, because a wrong length in the header could skip a whole frame.
NoitomDecoder::Step NoitomDecoder::other_header(std::uint8_t last_byte, NoitomRefusal meaning) {
  const auto bytes = ahead();
  if (bytes.size() < noitom_header_size) return Step::wait;
  if (bytes[62] != 0xff || bytes[63] != last_byte) {
    skip(1);
    return Step::go_on;
  }
  refuse(meaning);
  take(noitom_header_size);
  return Step::go_on;
}

/// Handles the beginning of a compressed stream, which is refused.
NoitomDecoder::Step NoitomDecoder::zipped() {
  const auto bytes = ahead();
  const auto mark = bytes.first(std::min<std::size_t>(4, bytes.size()));
  if (!std::all_of(mark.begin(), mark.end(), [](std::uint8_t b) { return b == 'C'; })) {
    skip(1);
    return Step::go_on;
  }
  if (bytes.size() < zipped_head) return Step::wait;
  if (bytes[8] != 0x1f || bytes[9] != 0x8b) {
    skip(1);
    return Step::go_on;
  }
  refuse(NoitomRefusal::compressed);
  take(zipped_head);
  return Step::go_on;
}

// Handles text from a digit to "||". If a byte can't occur in text, the text ends before that byte.
NoitomDecoder::Step NoitomDecoder::text(std::vector<NoitomArrival>& out) {
  const auto bytes = ahead();
  for (std::size_t at = searched_; at < bytes.size(); ++at) {
    if (!may_stand_in_text(bytes[at])) {
      skip(at);
      return Step::go_on;
    }
    if (bytes[at] == '|' && bytes[at - 1] == '|') {
      text_frame(at + 1, out);
      return Step::go_on;
    }
    if (at >= longest_text) {
      refuse(NoitomRefusal::too_long);
      skip(at);
      return Step::go_on;
    }
  }
  searched_ = bytes.size();
  return Step::wait;
}

void NoitomDecoder::text_frame(std::size_t size, std::vector<NoitomArrival>& out) {
  // The text ends with "||", which does not belong to the frame.
  auto frame = parse_noitom_text({reinterpret_cast<const char*>(&held_[at_]), size - 2});
  if (frame) {
    take(size);
    give(*std::move(frame), out);
  } else {
    refuse_text({reinterpret_cast<const char*>(&held_[at_]), size - 2});
    skip(size);
  }
  behind_text_ = true;
}

void NoitomDecoder::refuse_text(std::string_view text) {
  const NoitomNoFrame what = judge_noitom_text(text);
  // A receiver that starts in the middle of a frame gets only the frame's end. This is not counted
  // as a fault.
  const bool first = counts_.frames == 0 && counts_.refused == NoitomCounts{}.refused;
  if (first && what == NoitomNoFrame::numbers) return;
  refuse(what == NoitomNoFrame::other_count ? NoitomRefusal::wrong_count : NoitomRefusal::garbage);
}

/// Outputs a frame, and counts its number for its avatar.
void NoitomDecoder::give(NoitomFrame frame, std::vector<NoitomArrival>& out) {
  if (avatars_.size() == most_avatars && !avatars_.contains(frame.avatar)) {
    refuse(NoitomRefusal::too_many_avatars);
    return;
  }
  NoitomAvatar& avatar = avatars_[frame.avatar];
  avatar.index = frame.avatar;
  avatar.name = frame.name;
  ++avatar.frames;
  ++counts_.frames;
  NoitomArrival arrival{std::move(frame)};
  if (arrival.frame.frame_index) {
    arrival.order = avatar.by_index.push(*arrival.frame.frame_index);
    arrival.place = avatar.by_index.place();
  }
  out.push_back(std::move(arrival));
}

}  // namespace kinalign
