// SPDX-License-Identifier: Apache-2.0
// A script's line over the standard input and output.
#pragma once

#include "firmware/script/line.h"

#include <cstdio>

namespace kinalign {

class PipeLine : public Line {
 public:
  bool read(std::span<std::uint8_t> bytes) override {
    std::fflush(stdout);  // who waits for an answer has it before the next message
    return std::fread(bytes.data(), 1, bytes.size(), stdin) == bytes.size();
  }
  void write(std::span<const std::uint8_t> bytes) override {
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
  }
};

}  // namespace kinalign
