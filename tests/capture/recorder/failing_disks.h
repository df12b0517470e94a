// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinalign/core/files.h"

#include <atomic>
#include <cerrno>

namespace kinalign {

/// A disk that opens files but accepts no bytes while it is full.
struct FullDisk : PosixFiles {
  std::atomic<bool> full{false};

  int open(const char* path, int flags, mode_t mode) override {
    return full ? refuse() : PosixFiles::open(path, flags, mode);
  }
  ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) override {
    return full ? refuse() : PosixFiles::write_at(fd, data, size, at);
  }

 private:
  static int refuse() {
    errno = ENOSPC;
    return -1;
  }
};

/// A disk that accepts all bytes, but whose syncs fail, so that nothing is certainly stored.
struct FailingSyncs : PosixFiles {
  std::atomic<bool> fails{false};
  std::atomic<int> failed{0}, synced{0};

  int sync(int fd) override {
    const bool now = fails;
    ++(now ? failed : synced);
    if (!now) return PosixFiles::sync(fd);
    errno = EIO;
    return -1;
  }
};

}  // namespace kinalign
