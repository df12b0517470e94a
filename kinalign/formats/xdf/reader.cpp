// SPDX-License-Identifier: Apache-2.0
// Reads the chunks of an XDF file and the samples in them. Layout: docs/formats/xdf.md.
#include "kinalign/core/numbers.h"
#include "kinalign/formats/xdf/header.h"
#include "kinalign/formats/xdf/xdf.h"
#include "kinalign/wire/little_endian.h"
#include "kinalign/wire/little_endian_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace kinalign {

namespace {

constexpr std::string_view magic = "XDF:";
// Bytes that the format defines. A recorder writes them, so that a reader finds the next chunk
// after damage.
constexpr std::array<std::uint8_t, 16> boundary{0x43, 0xa5, 0x46, 0xdc, 0xcb, 0xf5, 0x41, 0x0f,
                                                0xb3, 0x0e, 0xd5, 0x46, 0x73, 0x83, 0xcb, 0xe4};
constexpr std::size_t tag_size = 2, id_size = 4;

bool is_gzip(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 2 && bytes[0] == 0x1f && bytes[1] == 0x8b;
}

// The bytes of a number. A string has no fixed size, so this function is not called for strings.
std::size_t bytes_of(XdfFormat format) {
  switch (format) {
    case XdfFormat::int8:
      return 1;
    case XdfFormat::int16:
      return 2;
    case XdfFormat::int32:
    case XdfFormat::float32:
      return 4;
    default:
      return 8;
  }
}

// All integers are stored as int64 and all real numbers as double. Both conversions are exact.
XdfValues room_for(XdfFormat format) {
  if (format == XdfFormat::string) return std::vector<std::string>{};
  const bool real = format == XdfFormat::float32 || format == XdfFormat::double64;
  return real ? XdfValues(std::vector<double>{}) : XdfValues(std::vector<std::int64_t>{});
}

/// Reads values from the front of a chunk's content. A value that is cut off is not read.
class Content {
 public:
  explicit Content(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t left() const { return bytes_.size() - at_; }

  template <class Number>
  std::optional<Number> take() {
    if (left() < sizeof(Number)) return std::nullopt;
    static_assert(std::endian::native == std::endian::little);
    Number number{};
    std::memcpy(&number, &bytes_[at_], sizeof number);
    at_ += sizeof number;
    return number;
  }

  /// Reads a length of 1, 4 or 8 bytes. The byte before the length states this width. Sizes of
  /// chunks, sizes of texts and numbers of samples have this form.
  std::optional<std::uint64_t> take_length() {
    const auto width = take<std::uint8_t>();
    if (width == 1) return take<std::uint8_t>();
    if (width == 4) return take<std::uint32_t>();
    if (width == 8) return take<std::uint64_t>();
    return std::nullopt;
  }

  std::optional<std::string> take_text() {
    const auto length = take_length();
    // The length is checked before memory is allocated.
    if (!length || *length > left()) return std::nullopt;
    const auto* from = reinterpret_cast<const char*>(bytes_.data() + at_);
    at_ += static_cast<std::size_t>(*length);
    return std::string(from, static_cast<std::size_t>(*length));
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Appends a number that has the type Number in the file. Returns false if its bytes are
/// incomplete.
template <class Number, class Value>
bool append_number(Content& content, std::vector<Value>& out) {
  const auto number = content.take<Number>();
  if (number) out.push_back(static_cast<Value>(*number));
  return number.has_value();
}

/// Appends a value of the stream's format. Returns false if its bytes are incomplete.
bool append_value(XdfFormat format, Content& content, XdfValues& values) {
  if (auto* text = std::get_if<std::vector<std::string>>(&values)) {
    auto value = content.take_text();
    if (!value) return false;
    text->push_back(*std::move(value));
    return true;
  }
  if (auto* real = std::get_if<std::vector<double>>(&values)) {
    return format == XdfFormat::float32 ? append_number<float>(content, *real)
                                        : append_number<double>(content, *real);
  }
  auto& whole = std::get<std::vector<std::int64_t>>(values);
  switch (format) {
    case XdfFormat::int8:
      return append_number<std::int8_t>(content, whole);
    case XdfFormat::int16:
      return append_number<std::int16_t>(content, whole);
    case XdfFormat::int32:
      return append_number<std::int32_t>(content, whole);
    default:
      return append_number<std::int64_t>(content, whole);
  }
}

/// Appends one sample. If it is incomplete, appends nothing and returns false.
bool append_sample(const XdfStream& stream, Content& content, double& last_stamp, XdfSamples& out) {
  // This size is used to remove the values of an incomplete sample.
  const std::size_t before = std::visit([](const auto& v) { return v.size(); }, out.values);
  const auto width = content.take<std::uint8_t>();
  double stamp = last_stamp;
  if (width == 8) {
    const auto stated = content.take<double>();
    if (!stated) return false;
    stamp = *stated;
  } else if (width == 0) {
    // The file omits this stamp. It is one sample period after the previous stamp.
    stamp += stream.nominal_rate_hz > 0.0 ? 1.0 / stream.nominal_rate_hz : 0.0;
  } else {
    return false;
  }
  // Memory for the channels is allocated only if their bytes are present.
  const bool text = stream.format == XdfFormat::string;
  if (stream.channel_count > content.left() / (text ? 2 : bytes_of(stream.format))) return false;
  for (std::uint32_t c = 0; c < stream.channel_count; ++c) {
    if (append_value(stream.format, content, out.values)) continue;
    // The values are removed, so that there is one stamp for each sample.
    std::visit([before](auto& v) { v.resize(before); }, out.values);
    return false;
  }
  // An incomplete sample does not change the last stamp.
  last_stamp = stamp;
  out.stamps.push_back(stamp);
  out.deduced.push_back(width == 0 ? 1 : 0);
  return true;
}

/// The complete samples in `bytes`, which begin with the number of samples. If the file omits a
/// stamp, it is computed from `last_stamp`, which the stream keeps between chunks. `what_is_wrong`
/// is set if the number of samples differs from the stated number, or if bytes follow the last
/// sample.
XdfSamples parse_samples(const XdfStream& stream, std::span<const std::uint8_t> bytes,
                         double& last_stamp, std::optional<Error>& what_is_wrong) {
  XdfSamples samples;
  samples.stream = stream.id;
  samples.values = room_for(stream.format);
  Content content(bytes);
  // No memory is allocated for the stated number. Samples are appended as they are read.
  const auto stated = content.take_length();
  if (!stated) {
    what_is_wrong = Error{"", 0, "a number of samples", "none"};
    return samples;
  }
  while (samples.size() < *stated && append_sample(stream, content, last_stamp, samples)) {
  }
  // The chunk contains fewer or more bytes than its samples need.
  if (samples.size() < *stated) {
    what_is_wrong = Error{"", 0, "as many whole samples in a chunk as it states",
                          fmt::format("{} of {}", samples.size(), *stated)};
  } else if (content.left() > 0) {
    what_is_wrong = Error{"", 0, "the end of the chunk after its samples",
                          std::to_string(content.left()) + " bytes"};
  }
  return samples;
}

}  // namespace

bool looks_like_xdf(std::string_view head) { return head.starts_with(magic); }

Result<void> XdfReader::feed(std::string_view piece, std::vector<XdfItem>& out) {
  // Used bytes are removed only at the end, so that views stay valid during this call.
  held_.insert(held_.end(), piece.begin(), piece.end());
  if (KA_TRY(begun())) {
    while (step(out)) {
    }
  }
  held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(at_));
  at_ = 0;
  return {};
}

/// Checks the first bytes of the file. Returns false until they are complete.
Result<bool> XdfReader::begun() {
  if (begun_) return true;
  // A compressed file gets its own message.
  if (is_gzip(held_)) {
    return refuse(name_, "an XDF file, unpacked (gzip -d)", "a file packed by gzip");
  }
  const std::string_view head = text_of(held_).substr(0, magic.size());
  // The beginning may arrive in two pieces, so only the present bytes are compared.
  if (head != magic.substr(0, head.size())) {
    return refuse(name_, "XDF: at the beginning", "'" + shown(head) + "'");
  }
  if (held_.size() < magic.size()) return false;
  begun_ = true;
  take(magic.size());
  return true;
}

Result<void> XdfReader::finish(std::vector<XdfItem>& out) {
  if (!begun_) {
    return refuse(name_, "XDF: at the beginning", "the end of the file");
  }
  while (step(out)) {
  }
  // The file may end within a chunk.
  const std::size_t left = ahead().size();
  if (left == 0) return {};
  Chunk chunk;
  // The length of the chunk may be known although its content is missing.
  const bool whole_head = !lost_ && find_chunk(chunk) == Found::chunk;
  fault(whole_head ? fmt::format("a last chunk of {} bytes", chunk.size)
                   : std::string("a complete chunk at the end of the file"),
        fmt::format("{} bytes", whole_head ? held_.size() - chunk.content : left));
  take(left);
  return {};
}

void XdfReader::take(std::size_t bytes) {
  at_ += bytes;
  offset_ += bytes;
  // The position has changed, so the search for a boundary begins again.
  searched_ = 0;
}

// Handles one chunk. Returns false if more bytes are needed.
bool XdfReader::step(std::vector<XdfItem>& out) {
  // After damage, reading continues at the next boundary.
  if (lost_) return resynchronise();
  if (ahead().empty()) return false;
  Chunk found;
  const Found what = find_chunk(found);
  if (what == Found::more) return false;
  if (what == Found::damage) {
    fault("the length of a chunk", "other bytes");
    lost_ = true;
    return true;
  }
  const std::size_t head = found.content - at_;
  const std::size_t there = ahead().size() - head;
  const bool whole = found.size <= there;
  const std::size_t end = head + (whole ? static_cast<std::size_t>(found.size) : there);
  // If a boundary is inside a chunk, the length of the chunk is wrong.
  const auto inside = boundary_before(end);
  // A boundary chunk contains the boundary as its content.
  const bool is_boundary = inside == head + tag_size && found.size == tag_size + boundary.size() &&
                           little_at<std::uint16_t>(held_, found.content) == 5;
  if (inside && !is_boundary) {
    fault("a chunk that ends before the next boundary",
          fmt::format("a chunk of {} bytes", found.size));
    lost_ = true;
    return true;
  }
  // The rest of the chunk is needed, but the file may end before it.
  if (!whole) return false;
  chunk(ahead().subspan(head, static_cast<std::size_t>(found.size)), out);
  take(end);
  return true;
}

XdfReader::Found XdfReader::find_chunk(Chunk& chunk) const {
  const auto bytes = ahead();
  // The first byte is the width of the length.
  const std::size_t width = bytes[0];
  if (width != 1 && width != 4 && width != 8) return Found::damage;
  if (bytes.size() < 1 + width) return Found::more;
  chunk.content = at_ + 1 + width;
  if (width == 1) chunk.size = bytes[1];
  if (width == 4) chunk.size = little_at<std::uint32_t>(bytes, 1);
  if (width == 8) chunk.size = little_at<std::uint64_t>(bytes, 1);
  // A chunk contains at least its tag.
  return chunk.size < tag_size ? Found::damage : Found::chunk;
}

// The position of the first boundary (16 bytes) in the next `end` bytes.
std::optional<std::size_t> XdfReader::boundary_before(std::size_t end) {
  const auto bytes = ahead().first(end);
  const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(searched_, end));
  const auto found = std::search(from, bytes.end(), boundary.begin(), boundary.end());
  if (found != bytes.end()) return static_cast<std::size_t>(found - bytes.begin());
  // The last 15 bytes may begin a boundary, so they are searched again later.
  if (end >= boundary.size()) searched_ = std::max(searched_, end - boundary.size() + 1);
  return std::nullopt;
}

// Skips all bytes up to the end of the next boundary. Bytes that can't belong to a boundary are
// dropped.
bool XdfReader::resynchronise() {
  const auto found = boundary_before(ahead().size());
  if (!found) {
    take(searched_);
    return false;
  }
  take(*found + boundary.size());
  lost_ = false;
  return true;
}

/// Handles a complete chunk. `bytes` are its tag and content.
void XdfReader::chunk(std::span<const std::uint8_t> bytes, std::vector<XdfItem>& out) {
  const auto tag = little_at<std::uint16_t>(bytes, 0);
  const auto content = bytes.subspan(tag_size);
  // The file's header is only checked.
  if (tag == 1 && text_of(content).find("<version>1.0</version>") == std::string_view::npos) {
    fault("a file header that says version 1.0", "another version");
  }
  // Chunks with the tags 2, 3 and 4 begin with the id of a stream.
  if (tag >= 2 && tag <= 4 && content.size() < id_size) {
    fault("the id of a stream", "a chunk without an id");
    return;
  }
  if (tag == 2) stream_header(content, out);
  if (tag == 3) samples(content, out);
  if (tag == 4) clock_offset(content, out);
  if (tag == 0 || tag > 6) fault("chunks of kinds 1 to 6", fmt::format("a chunk of kind {}", tag));
}

/// Parses the header of a stream. If the header can't be used, the samples of the stream are
/// skipped.
void XdfReader::stream_header(std::span<const std::uint8_t> content, std::vector<XdfItem>& out) {
  const auto id = little_at<std::uint32_t>(content, 0);
  // A second header could change the meaning of earlier samples.
  if (streams_.contains(id)) {
    fault("one header for each stream", fmt::format("a second header for stream {}", id));
    return;
  }
  std::vector<Error> notes;
  auto header = parse_xdf_header(id, text_of(content.subspan(id_size)), notes);
  for (const Error& note : notes) {
    fault(fmt::format("{} in the header of stream {}", note.expected, id), note.found);
  }
  if (!header) {
    fault(fmt::format("{} in the header of stream {}", header.error().expected, id),
          header.error().found + ": its samples can't be read");
    // The stream is stored without a header, so that its samples are not reported as further
    // faults.
    streams_[id] = std::nullopt;
    return;
  }
  streams_[id] = Stream{*header};
  out.emplace_back(*std::move(header));
}

void XdfReader::samples(std::span<const std::uint8_t> content, std::vector<XdfItem>& out) {
  const auto id = little_at<std::uint32_t>(content, 0);
  const auto known = streams_.find(id);
  if (known == streams_.end()) {
    fault("samples of streams with a header",
          fmt::format("samples of stream {} without a header", id));
    return;
  }
  if (!known->second) return;  // the header of the stream can't be used
  std::optional<Error> wrong;
  XdfSamples read = parse_samples(known->second->header, content.subspan(id_size),
                                  known->second->last_stamp, wrong);
  // The samples before the fault are complete, so they are passed on.
  if (wrong) fault(wrong->expected, fmt::format("{} (stream {})", wrong->found, id));
  if (read.size() > 0) out.emplace_back(std::move(read));
}

/// Parses an offset of a sender's clock that the recorder measured.
void XdfReader::clock_offset(std::span<const std::uint8_t> content, std::vector<XdfItem>& out) {
  if (content.size() != id_size + 16) {
    fault("a clock offset of 20 bytes", std::to_string(content.size()));
    return;
  }
  // Two doubles follow the id.
  const auto number = [&](std::size_t at) {
    return std::bit_cast<double>(little_at<std::uint64_t>(content, at));
  };
  const XdfClockOffset offset{little_at<std::uint32_t>(content, 0), number(4), number(12)};
  if (!(std::abs(offset.time) < largest_number) || !(std::abs(offset.offset) < largest_number)) {
    fault("clock offsets below 1e15", "others");
    return;
  }
  out.emplace_back(offset);
}

/// Counts a fault. After 100 kinds of faults, further faults count as the last kind.
void XdfReader::fault(const std::string& expected, const std::string& found) {
  constexpr std::size_t most_kinds = 100;
  // Faults of the same kind have the same `expected`; `found` may differ.
  for (Fault& known : faults_) {
    const bool same = known.expected == expected;
    if (same || (&known == &faults_.back() && faults_.size() == most_kinds)) {
      ++known.times;
      return;
    }
  }
  faults_.push_back({1, offset_, expected, found});
}

Findings XdfReader::findings() const {
  Findings findings;
  for (const Fault& f : faults_) {
    const std::string times = f.times > 1 ? fmt::format(", {} times", f.times) : "";
    add_warning(
        findings,
        {name_, 0, f.expected, fmt::format("{} at byte {}{}", f.found, f.first_offset, times)},
        "all readable chunks were read");
  }
  return findings;
}

}  // namespace kinalign
