// SPDX-License-Identifier: Apache-2.0
// The line of a script over standard input and output.
#pragma once

#include "firmware/script/line.h"

#include <cstdio>

namespace kinalign {

class PipeLine : public Line {
 public:
  bool read(std::span<std::uint8_t> bytes) override {
    std::fflush(stdout);  // a program that waits for an answer gets it before the node reads on
    return std::fread(bytes.data(), 1, bytes.size(), stdin) == bytes.size();
  }
  void write(std::span<const std::uint8_t> bytes) override {
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
  }
};

}  // namespace kinalign
