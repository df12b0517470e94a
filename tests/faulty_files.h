// SPDX-License-Identifier: Apache-2.0
// The machine's files with one call that fails, for tests of all code that writes or reads files.
#pragma once

#include "kinalign/core/files.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace kinalign {

/// Works like the machine's files. Removing always works, and a close that fails has closed the
/// file nevertheless, as on Linux.
class FaultyFiles final : public FileSystem {
 public:
  int fail_at = 0;              // the call that fails, from 1; 0: none
  int code = ENOSPC;            // errno of the failing call
  bool nameless = true;         // whether O_TMPFILE works
  std::size_t most = SIZE_MAX;  // most bytes of a write, and of a read at an offset
  /// Bytes that the first read gives; each later one gives one more; 0: all.
  std::size_t first_read = 0;
  int calls = 0;

  bool failed() const { return fail_at != 0 && calls >= fail_at; }

  int open(const char* path, int flags, mode_t mode) override {
    if (fails()) return -1;
    if (!nameless && (flags & O_TMPFILE) == O_TMPFILE) {
      errno = EOPNOTSUPP;
      return -1;
    }
    return files_.open(path, flags, mode);
  }
  ssize_t read(int fd, void* data, std::size_t size) override {
    if (first_read > 0) size = std::min(size, first_read++);
    return fails() ? -1 : files_.read(fd, data, size);
  }
  ssize_t write(int fd, const void* data, std::size_t size) override {
    return fails() ? -1 : files_.write(fd, data, std::min(size, most));
  }
  ssize_t read_at(int fd, void* data, std::size_t size, off_t at) override {
    return fails() ? -1 : files_.read_at(fd, data, std::min(size, most), at);
  }
  ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) override {
    return fails() ? -1 : files_.write_at(fd, data, std::min(size, most), at);
  }
  int allocate(int fd, off_t size) override { return fails() ? -1 : files_.allocate(fd, size); }
  int truncate(int fd, off_t size) override { return fails() ? -1 : files_.truncate(fd, size); }
  int sync(int fd) override { return fails() ? -1 : files_.sync(fd); }
  int link(const char* from, const char* to) override {
    return fails() ? -1 : files_.link(from, to);
  }
  int rename(const char* from, const char* to) override {
    return fails() ? -1 : files_.rename(from, to);
  }
  int remove(const char* path) override { return files_.remove(path); }
  int close(int fd) override {
    const bool failing = fails();
    files_.close(fd);
    return failing ? -1 : 0;
  }

 private:
  bool fails() {
    if (++calls != fail_at) return false;
    errno = code;
    return true;
  }

  PosixFiles files_;
};

/// The machine's files, but the disk can't read one page of a file.
class BadPage final : public PosixFiles {
 public:
  static constexpr off_t size = 4096;
  BadPage(std::string path, off_t at) : path_(std::move(path)), at_(at / size * size) {}

  int open(const char* path, int flags, mode_t mode) override {
    const int fd = PosixFiles::open(path, flags, mode);
    if (path == path_) next_[fd] = 0;
    return fd;
  }
  int close(int fd) override {
    next_.erase(fd);
    return PosixFiles::close(fd);
  }
  ssize_t read(int fd, void* data, std::size_t want) override {
    const auto next = next_.find(fd);
    if (next == next_.end()) return PosixFiles::read(fd, data, want);
    const off_t left = at_ - next->second;  // bytes before the page
    if (left == 0) {
      errno = EIO;
      return -1;
    }
    if (left > 0) want = std::min(want, static_cast<std::size_t>(left));
    const ssize_t got = PosixFiles::read(fd, data, want);
    next->second += std::max<ssize_t>(got, 0);
    return got;
  }

 private:
  std::string path_;
  off_t at_;
  std::map<int, off_t> next_;  // offset of the next read() of each descriptor
};

}  // namespace kinalign
