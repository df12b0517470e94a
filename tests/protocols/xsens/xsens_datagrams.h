// SPDX-License-Identifier: Apache-2.0
// Writes samples in the form of Xsens MVN, for tests and the fuzzer. Layout:
// docs/formats/xsens_mvn_stream.md.
#pragma once

#include "kinalign/protocols/xsens/sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kinalign {

/// The form of the datagrams: programs of different age send different forms.
struct XsensSending {
  std::size_t items_per_datagram = 255;
  bool payload_size = true;     // false: send 0, as programs before 2019 do
  bool long_time_code = false;  // true: with its length in front, as newer programs send it
};

/// Appends fields one after another, in network order.
class XsensFields {
 public:
  XsensFields& put(std::integral auto value) {
    for (std::size_t i = sizeof value; i-- > 0;) {
      bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
    }
    return *this;
  }
  template <std::size_t n>
  XsensFields& put(const std::array<float, n>& values) {
    for (const float value : values) put(std::bit_cast<std::uint32_t>(value));
    return *this;
  }
  XsensFields& put(std::string_view text) {
    bytes.insert(bytes.end(), text.begin(), text.end());
    return *this;
  }
  std::vector<std::uint8_t> bytes;
};

/// The items of a sample, one by one, so that a sample can be divided at any item.
struct XsensItemBytes {
  unsigned type = 0;
  std::vector<std::vector<std::uint8_t>> items;
};

inline XsensItemBytes item_bytes(const XsensPose& pose, const XsensSending& /*how*/) {
  XsensItemBytes all{2, {}};
  for (const XsensSegment& s : pose.segments) {
    all.items.push_back(XsensFields().put(s.id).put(s.position).put(s.rotation).bytes);
  }
  return all;
}

inline XsensItemBytes item_bytes(const XsensTrackers& trackers, const XsensSending& /*how*/) {
  XsensItemBytes all{23, {}};
  for (const XsensTracker& t : trackers.trackers) {
    XsensFields item;
    item.put(t.id).put(t.rotation).put(t.free_acceleration);
    if (t.raw) item.put(t.raw->acceleration).put(t.raw->angular_velocity);
    all.items.push_back(item.put(t.magnetic_field).bytes);
  }
  return all;
}

/// "HH:MM:SS.mmm"
inline XsensItemBytes item_bytes(const XsensTimeCode& code, const XsensSending& how) {
  const std::int64_t ms = code.time_of_day.count() / 1'000'000;
  const std::string text = fmt::format("{:02}:{:02}:{:02}.{:03}", ms / 3'600'000, ms / 60'000 % 60,
                                       ms / 1000 % 60, ms % 1000);
  XsensFields item;
  if (how.long_time_code) item.put(static_cast<std::uint32_t>(text.size()));
  return {25, {item.put(text).bytes}};
}

/// The datagrams of a sample; over TCP they follow one another.
inline std::vector<std::vector<std::uint8_t>> xsens_datagrams(const XsensSample& s,
                                                              const XsensSending& how) {
  const XsensItemBytes all =
      std::visit([&](const auto& body) { return item_bytes(body, how); }, s.body);
  std::vector<std::vector<std::uint8_t>> datagrams;
  for (std::size_t first = 0; first < all.items.size(); first += how.items_per_datagram) {
    const std::size_t some = std::min(how.items_per_datagram, all.items.size() - first);
    const std::size_t last = first + some == all.items.size() ? 0x80 : 0;
    XsensFields items;
    for (std::size_t k = first; k < first + some; ++k) {
      items.bytes.insert(items.bytes.end(), all.items[k].begin(), all.items[k].end());
    }
    XsensFields datagram;
    datagram.put(fmt::format("MXTP{:02}", all.type)).put(s.counter);
    datagram.put(static_cast<std::uint8_t>(last | datagrams.size()));
    datagram.put(static_cast<std::uint8_t>(some)).put(s.time_code_ms).put(s.character);
    datagram.put(s.body_segments).put(s.props).put(s.finger_segments).put(std::uint16_t{0});
    datagram.put(static_cast<std::uint16_t>(how.payload_size ? items.bytes.size() : 0));
    datagram.bytes.insert(datagram.bytes.end(), items.bytes.begin(), items.bytes.end());
    datagrams.push_back(std::move(datagram.bytes));
  }
  return datagrams;
}

}  // namespace kinalign
