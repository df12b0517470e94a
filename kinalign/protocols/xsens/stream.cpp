// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/xsens/stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace kinalign {

namespace {

// The bytes that are handled at once. The buffer therefore contains at most one incomplete datagram
// and one slice, even if the caller passes a long piece.
constexpr std::size_t slice = 4096;
constexpr std::size_t marker = 6;          // the size of a marker such as "MXTP02"
constexpr std::size_t most_channels = 48;  // 16 characters of three types
// A channel keeps at most this many incomplete samples. If another sample begins, the oldest one is
// dropped.
constexpr std::size_t most_parts = 4;

// Only poses, trackers and time codes are read. Other types are counted and skipped.
bool is_read(unsigned type) { return type == 2 || type == 23 || type == 25; }

// True if the trackers have the long form. All trackers of a datagram have the same form, so the
// first tracker is enough.
bool is_raw(const XsensSample& sample) {
  const auto* trackers = std::get_if<XsensTrackers>(&sample.body);
  return trackers != nullptr && trackers->trackers[0].raw.has_value();
}

/// Appends the items of `more` to those of `all`.
void append(XsensSample& all, XsensSample& more) {
  const auto move_behind = [](auto& to, auto& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  if (auto* pose = std::get_if<XsensPose>(&all.body)) {
    move_behind(pose->segments, std::get<XsensPose>(more.body).segments);
  } else if (auto* trackers = std::get_if<XsensTrackers>(&all.body)) {
    move_behind(trackers->trackers, std::get<XsensTrackers>(more.body).trackers);
  }
}

constexpr std::array<std::string_view, 6> names{
    "wrong_size", "interrupted", "incomplete", "repeated", "too_many_items", "too_many_characters"};
constexpr std::array<std::string_view, 6> meanings{
    "datagrams of an unknown layout were dropped",
    "datagrams that lacked a piece were dropped",
    "samples that lacked a datagram were dropped",
    "duplicate datagrams were dropped",
    "samples with more items than a body has were dropped",
    "samples of further characters were dropped"};

}  // namespace

std::string_view to_string(XsensRefusal refusal) {
  return names[static_cast<std::size_t>(refusal)];
}

// Connections and datagrams are decoded in the same way. Each slice is decoded as far as possible
// before the next slice is copied.
void XsensDecoder::feed(std::span<const std::uint8_t> bytes, std::vector<XsensArrival>& out) {
  while (!bytes.empty()) {
    const auto piece = bytes.first(std::min(slice, bytes.size()));
    bytes = bytes.subspan(piece.size());
    held_.insert(held_.end(), piece.begin(), piece.end());
    while (step(out)) {
    }
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ = 0;
  }
}

void XsensDecoder::take(std::size_t bytes) {
  at_ += bytes;
  searched_ = 0;
}

// Handles the data at the front. Returns false if more bytes are needed.
bool XsensDecoder::step(std::vector<XsensArrival>& out) {
  const auto bytes = ahead();
  if (bytes.size() < marker) return false;
  if (!begins_xsens_header(bytes)) {
    ++counts_.bytes_skipped;
    take(1);
    return true;
  }
  // If another datagram begins within a header, the header's size is not valid. This is therefore
  // checked before the size is read.
  if (skip_interrupted(xsens_header_size)) return true;
  if (bytes.size() < xsens_header_size) return false;
  const XsensHeader header = parse_xsens_header(bytes);
  const std::size_t size = xsens_header_size + header.payload;
  if (skip_interrupted(size)) return true;
  if (bytes.size() < size) return false;
  if (is_read(header.type)) {
    auto items = parse_xsens_items(header, bytes.subspan(xsens_header_size, header.payload));
    if (!items) {  // the header's size may be wrong, too
      refuse(XsensRefusal::wrong_size);
      counts_.bytes_skipped += marker;
      take(marker);
      return true;
    }
    datagram(header, *std::move(items), out);
  } else {
    ++counts_.other_types[header.type];
  }
  take(size);
  return true;
}

// Skips the datagram at the front if another datagram begins within its next `size` bytes. Only
// bytes that have arrived are checked.
bool XsensDecoder::skip_interrupted(std::size_t size) {
  const auto bytes = ahead();
  const std::size_t end = std::min(size, bytes.size());
  for (std::size_t at = std::max(searched_, marker); at + marker <= end; ++at) {
    if (begins_xsens_header(bytes.subspan(at))) {
      refuse(XsensRefusal::interrupted);
      counts_.bytes_skipped += at;
      take(at);
      return true;
    }
    searched_ = at + 1;
  }
  return false;
}

// Most samples consist of one datagram and need no joining.
void XsensDecoder::datagram(const XsensHeader& header, XsensItems items,
                            std::vector<XsensArrival>& out) {
  Channel* channel = channel_of(header);
  if (channel == nullptr) return refuse(XsensRefusal::too_many_characters);
  XsensSample sample{header.counter, header.time_code_ms,    header.character, header.body_segments,
                     header.props,   header.finger_segments, std::move(items)};
  if (header.index == 0 && header.last) return give(*channel, std::move(sample), out);
  join(*channel, header, std::move(sample), out);
}

// The number of channels is limited, because a damaged or hostile datagram may name any character.
XsensDecoder::Channel* XsensDecoder::channel_of(const XsensHeader& header) {
  const XsensChannel key{header.character, header.type};
  if (channels_.size() == most_channels && !channels_.contains(key)) return nullptr;
  return &channels_[key];
}

/// Adds a datagram to its sample and outputs the sample once it is complete.
void XsensDecoder::join(Channel& channel, const XsensHeader& header, XsensSample piece,
                        std::vector<XsensArrival>& out) {
  // A sample that was output is not in the list of incomplete samples. Without this check, a
  // repeated datagram would begin the sample again.
  if (channel.joined == header.counter) return refuse(XsensRefusal::repeated);
  Part& part = part_of(channel, header.counter);
  if (part.pieces.contains(header.index)) return refuse(XsensRefusal::repeated);
  if (part.items + header.items > most_xsens_items) return refuse(XsensRefusal::too_many_items);
  // A sample can't contain both trackers with raw values and trackers without.
  if (!part.pieces.empty() && is_raw(part.pieces.begin()->second) != is_raw(piece)) {
    return refuse(XsensRefusal::wrong_size);
  }
  part.items += header.items;
  if (header.last) part.last = header.index;
  part.pieces.emplace(header.index, std::move(piece));
  // All pieces have different numbers. If there are as many pieces as the last number requires, and
  // no number is higher, the sample is complete.
  const bool whole = part.last && part.pieces.size() == *part.last + 1U &&
                     part.pieces.rbegin()->first == *part.last;
  if (!whole) return;
  XsensSample sample = std::move(part.pieces.begin()->second);
  for (auto more = std::next(part.pieces.begin()); more != part.pieces.end(); ++more) {
    append(sample, more->second);
  }
  channel.joined = header.counter;
  std::erase_if(channel.parts, [&](const auto& p) { return p.first == header.counter; });
  give(channel, std::move(sample), out);
}

/// The incomplete sample with this counter. If there are too many incomplete samples, the oldest
/// one is dropped.
XsensDecoder::Part& XsensDecoder::part_of(Channel& channel, std::uint32_t counter) {
  for (auto& [known, part] : channel.parts) {
    if (known == counter) return part;
  }
  if (channel.parts.size() == most_parts) {
    channel.parts.pop_front();
    refuse(XsensRefusal::incomplete);
  }
  return channel.parts.emplace_back(counter, Part{}).second;
}

// Samples are output in the order in which they became complete. `order` tells the caller which
// samples are late.
void XsensDecoder::give(Channel& channel, XsensSample sample, std::vector<XsensArrival>& out) {
  const Order order = channel.by_counter.push(sample.counter);
  ++counts_.samples;
  out.push_back({std::move(sample), order, channel.by_counter.place()});
}

std::map<XsensChannel, SequenceCounts> XsensDecoder::channels() const {
  std::map<XsensChannel, SequenceCounts> all;
  for (const auto& [key, channel] : channels_) all[key] = channel.by_counter.counts();
  return all;
}

// Makes one warning for each kind of refusal, and one note for each skipped type.
Findings XsensDecoder::findings(const std::string& name) const {
  Findings findings;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::uint64_t times = counts_.refused[k];
    if (times == 0) continue;
    findings.push_back({Severity::warning,
                        Error{name, 0, "whole datagrams of MVN, each once",
                              fmt::format("{} ({})", names[k],
                                          times == 1 ? "once" : fmt::format("{} times", times))},
                        std::string(meanings[k]), ""});
  }
  for (std::size_t type = 0; type < counts_.other_types.size(); ++type) {
    if (counts_.other_types[type] == 0) continue;
    findings.push_back({Severity::note,
                        Error{name, 0, "datagrams of types 02, 23 and 25",
                              fmt::format("{} of type {:02}", counts_.other_types[type], type)},
                        "these datagrams were skipped", ""});
  }
  return findings;
}

}  // namespace kinalign
