// SPDX-License-Identifier: Apache-2.0
// Parses the 24 bytes in front of each datagram of Xsens MVN, and the items after them.
#pragma once

#include "kinalign/protocols/xsens/sample.h"

#include <span>

namespace kinalign {

/// Positions and meanings of the header's fields: docs/formats/xsens_mvn_stream.md.
constexpr std::size_t xsens_header_size = 24;
/// Most items of a sample; a body with props and hands has 67.
constexpr std::size_t most_xsens_items = 256;

/// The header of one datagram. A sample is divided into several datagrams if it does not fit into
/// one; these share character, type and counter.
struct XsensHeader {
  unsigned type = 0;          // 0 to 99
  std::uint32_t counter = 0;  // number of the sample
  std::uint8_t index = 0;     // number of the datagram within the sample, 0 to 127
  bool last = false;          // true: the sample's last datagram
  std::uint8_t items = 0;
  std::uint32_t time_code_ms = 0;
  std::uint8_t character = 0, body_segments = 0, props = 0, finger_segments = 0;
  std::size_t payload = 0;  // bytes after the header; computed if the sender states 0
};

/// True if the bytes begin with "MXTP" and two digits.
bool begins_xsens_header(std::span<const std::uint8_t> bytes);

/// Parses 24 bytes that begin so.
XsensHeader parse_xsens_header(std::span<const std::uint8_t> bytes);

/// Bytes of an item of this type; 0: unknown type. Type 23 has two sizes; this is the smaller one.
std::size_t xsens_item_size(unsigned type);

/// The items of a datagram of type 02, 23 or 25. Empty if their size does not fit the type and the
/// header's number of items, or if a time code is no time of day.
std::optional<XsensItems> parse_xsens_items(const XsensHeader& header,
                                            std::span<const std::uint8_t> payload);

}  // namespace kinalign
