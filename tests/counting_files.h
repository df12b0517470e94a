// SPDX-License-Identifier: Apache-2.0
// The disk's files, with a count of the bytes that are read.
#pragma once

#include "kinalign/core/files.h"

#include <algorithm>
#include <cstdint>

namespace kinalign {

/// Counts the bytes that are read.
class CountingFiles final : public PosixFiles {
 public:
  ssize_t read(int fd, void* data, std::size_t size) override {
    return counted(PosixFiles::read(fd, data, size));
  }
  ssize_t read_at(int fd, void* data, std::size_t size, off_t at) override {
    return counted(PosixFiles::read_at(fd, data, size, at));
  }
  std::uint64_t bytes = 0;

 private:
  ssize_t counted(ssize_t got) {
    bytes += static_cast<std::uint64_t>(std::max<ssize_t>(got, 0));
    return got;
  }
};

}  // namespace kinalign
