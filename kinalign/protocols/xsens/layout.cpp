// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/xsens/layout.h"

#include "kinalign/wire/bytes.h"

#include <string_view>

namespace kinalign {

namespace {

// The sizes of items in bytes: docs/formats/xsens_mvn_stream.md. The specification describes
// tracker items of 44 bytes, but MVN also sends items of 68 bytes.
constexpr std::size_t pose_item = 32, tracker_item = 44, raw_tracker_item = 68, time_code = 12;

bool is_digit(std::uint8_t b) { return b >= '0' && b <= '9'; }

// Functions that read items expect a payload of the right size: `items` times the size of an item.
XsensPose pose_of(ByteReader bytes, std::size_t items) {
  XsensPose pose;
  for (std::size_t k = 0; k < items; ++k) {
    XsensSegment segment;
    segment.id = bytes.take<std::int32_t>();
    segment.position = bytes.take_floats<3>();
    segment.rotation = bytes.take_floats<4>();
    pose.segments.push_back(segment);
  }
  return pose;
}

/// Reads tracker items. `raw`: the items have the long form, which includes raw measurements.
XsensTrackers trackers_of(ByteReader bytes, std::size_t items, bool raw) {
  XsensTrackers all;
  for (std::size_t k = 0; k < items; ++k) {
    XsensTracker tracker;
    tracker.id = bytes.take<std::int32_t>();
    tracker.rotation = bytes.take_floats<4>();
    tracker.free_acceleration = bytes.take_floats<3>();
    if (raw) {
      const auto acceleration = bytes.take_floats<3>();
      tracker.raw = {acceleration, bytes.take_floats<3>()};
    }
    tracker.magnetic_field = bytes.take_floats<3>();
    all.trackers.push_back(tracker);
  }
  return all;
}

/// Parses a time of day in the form "HH:MM:SS.mmm".
std::optional<XsensTimeCode> time_code_of(std::span<const std::uint8_t> text) {
  constexpr std::string_view form = "dd:dd:dd.ddd";
  for (std::size_t k = 0; k < form.size(); ++k) {
    if (form[k] == 'd' ? !is_digit(text[k]) : text[k] != static_cast<std::uint8_t>(form[k])) {
      return std::nullopt;
    }
  }
  const auto two = [&](std::size_t at) { return (text[at] - '0') * 10 + (text[at + 1] - '0'); };
  const int hours = two(0), minutes = two(3), whole = two(6), ms = two(9) * 10 + (text[11] - '0');
  if (hours > 23 || minutes > 59 || whole > 59) return std::nullopt;
  return XsensTimeCode{std::chrono::hours(hours) + std::chrono::minutes(minutes) +
                       std::chrono::seconds(whole) + std::chrono::milliseconds(ms)};
}

/// Parses a time code. Its length may stand in front of it.
std::optional<XsensTimeCode> any_time_code(std::span<const std::uint8_t> payload) {
  if (payload.size() == time_code) return time_code_of(payload);
  if (payload.size() != time_code + 4) return std::nullopt;
  if (ByteReader(payload).take<std::uint32_t>() != time_code) return std::nullopt;
  return time_code_of(payload.subspan(4));
}

}  // namespace

bool begins_xsens_header(std::span<const std::uint8_t> b) {
  return b.size() >= 6 && b[0] == 'M' && b[1] == 'X' && b[2] == 'T' && b[3] == 'P' &&
         is_digit(b[4]) && is_digit(b[5]);
}

// The sizes of other types are needed, too. A sender before 2019 states no payload size, so these
// datagrams can be skipped only by the size of their items.
std::size_t xsens_item_size(unsigned type) {
  switch (type) {
    case 1:
      return 28;
    case 2:
      return pose_item;
    case 3:
      return 16;
    case 5:
      return 32;
    case 20:
      return 20;
    case 21:
      return 40;
    case 22:
      return 44;
    case 23:
      return tracker_item;
    case 24:
      return 12;
    case 25:
      return time_code;
    default:
      return 0;
  }
}

XsensHeader parse_xsens_header(std::span<const std::uint8_t> bytes) {
  XsensHeader h;
  // The caller has checked the magic "MXTP". Two digits of the type follow it.
  h.type = static_cast<unsigned>((bytes[4] - '0') * 10 + (bytes[5] - '0'));
  ByteReader fields(bytes.subspan(6));
  h.counter = fields.take<std::uint32_t>();
  // Bit 7 marks the last datagram of the sample. The lower bits number the datagrams.
  const auto datagram = fields.take<std::uint8_t>();
  h.index = datagram & 0x7f;
  h.last = (datagram & 0x80) != 0;
  h.items = fields.take<std::uint8_t>();
  h.time_code_ms = fields.take<std::uint32_t>();
  h.character = fields.take<std::uint8_t>();
  h.body_segments = fields.take<std::uint8_t>();
  h.props = fields.take<std::uint8_t>();
  h.finger_segments = fields.take<std::uint8_t>();
  // Two reserved bytes are skipped.
  fields.take<std::uint16_t>();
  h.payload = fields.take<std::uint16_t>();
  if (h.payload == 0) h.payload = xsens_item_size(h.type) * h.items;
  return h;
}

// Type 23 has two forms, which differ only in the size of the payload. Type 25 does not use the
// number of items.
std::optional<XsensItems> parse_xsens_items(const XsensHeader& header,
                                            std::span<const std::uint8_t> payload) {
  const std::size_t items = header.items;
  if (header.type == 25) return any_time_code(payload);
  if (items == 0) return std::nullopt;
  if (header.type == 2 && payload.size() == pose_item * items) {
    return pose_of(ByteReader(payload), items);
  }
  const bool raw = payload.size() == raw_tracker_item * items;
  if (header.type == 23 && (raw || payload.size() == tracker_item * items)) {
    return trackers_of(ByteReader(payload), items, raw);
  }
  return std::nullopt;
}

}  // namespace kinalign
