// SPDX-License-Identifier: Apache-2.0
// The worked examples of docs/formats, read from the pages: the bytes that they show must be those
// that we read and send.
#pragma once

#include "tests/folder.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

namespace kinalign {

/// The bytes of the block ```text of docs/formats/`page` that begins with the line `name`. A line
/// is "0008  00 00 00 07  node id": an offset and up to eight bytes.
inline std::vector<std::uint8_t> bytes_of_page(const std::string& page, const std::string& name) {
  const std::string text = bytes_in(KINALIGN_SOURCE_DIR "/docs/formats/" + page);
  const std::string begin = "```text\n" + name + "\n";
  REQUIRE(text.find(begin) != std::string::npos);
  std::istringstream lines(text.substr(text.find(begin) + begin.size()));
  std::vector<std::uint8_t> bytes;
  for (std::string line; std::getline(lines, line) && line != "```";) {
    CHECK(std::stoul(line.substr(0, 4), nullptr, 16) == bytes.size());
    std::istringstream numbers(line.substr(6, 23));
    for (std::string number; numbers >> number;) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(number, nullptr, 16)));
    }
  }
  return bytes;
}

}  // namespace kinalign
