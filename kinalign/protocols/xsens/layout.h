// SPDX-License-Identifier: Apache-2.0
// Parses the 24 bytes in front of each datagram of Xsens MVN, and the items after these bytes.
#pragma once

#include "kinalign/protocols/xsens/sample.h"

#include <span>

namespace kinalign {

/// The size of the header in bytes. Its fields: docs/formats/xsens_mvn_stream.md.
constexpr std::size_t xsens_header_size = 24;
/// The most items of a sample. A body with props and hands has 67 items.
constexpr std::size_t most_xsens_items = 256;

/// The header of one datagram. A large sample is divided into several datagrams. These have the
/// same character, type and counter.
struct XsensHeader {
  unsigned type = 0;          // type of the items, 0 to 99
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

/// Parses 24 bytes that begin with "MXTP" and two digits.
XsensHeader parse_xsens_header(std::span<const std::uint8_t> bytes);

/// The bytes of an item of this type; 0 if the type is unknown. Type 23 has two sizes, and this is
/// the smaller one.
std::size_t xsens_item_size(unsigned type);

/// The items of a datagram of type 02, 23 or 25. The result is empty if their size does not fit the
/// type and the header's number of items. It is also empty if a time code is not a time of day.
std::optional<XsensItems> parse_xsens_items(const XsensHeader& header,
                                            std::span<const std::uint8_t> payload);

}  // namespace kinalign
