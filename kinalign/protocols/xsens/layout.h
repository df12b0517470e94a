// SPDX-License-Identifier: Apache-2.0
// The 24 bytes in front of each datagram of Xsens MVN and the items behind them.
#pragma once

#include "kinalign/protocols/xsens/sample.h"

#include <span>

namespace kinalign {

constexpr std::size_t xsens_header_size = 24;
constexpr std::size_t most_xsens_items = 256;  // of a sample; a body with props and hands has 67

struct XsensHeader {
  unsigned type = 0;          // 0 to 99
  std::uint32_t counter = 0;  // of samples
  std::uint8_t index = 0;     // of the sample's datagrams, 0 to 127
  bool last = false;          // of the sample's datagrams
  std::uint8_t items = 0;
  std::uint32_t time_code_ms = 0;
  std::uint8_t character = 0, body_segments = 0, props = 0, finger_segments = 0;
  std::size_t payload = 0;  // bytes behind the header, also where the sender left that out
};

/// "MXTP" and two digits stand in front.
bool begins_xsens_header(std::span<const std::uint8_t> bytes);

/// Reads 24 bytes that begin so.
XsensHeader parse_xsens_header(std::span<const std::uint8_t> bytes);

/// Bytes of an item of this type; 0: none that is known. Type 23 has two sizes, this is the
/// smaller.
std::size_t xsens_item_size(unsigned type);

/// The items of a datagram of type 02, 23 or 25. Nothing where their size is not what the type and
/// the header's number ask for, or a time code is no time.
std::optional<XsensItems> parse_xsens_items(const XsensHeader& header,
                                            std::span<const std::uint8_t> payload);

}  // namespace kinalign
