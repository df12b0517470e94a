// SPDX-License-Identifier: Apache-2.0
// What files.cpp and growing_file.cpp make of single system calls: interrupted ones are repeated,
// short ones go on.
#pragma once

#include "kinalign/core/files.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>

namespace kinalign {

inline Failure failed(const std::string& path, std::string expected, int code) {
  return Failure(Error{path, 0, std::move(expected), std::strerror(code)});
}

/// A file could not be opened or read.
inline Failure unreadable(const std::string& path, int code) {
  const ErrorKind kind = code == EIO ? ErrorKind::unreadable_disk : ErrorKind::other;
  return Failure(Error{path, 0, "a readable file", std::strerror(code), kind});
}

/// Reads until `to` is full or the file ends.
inline Result<std::size_t> fill(FileSystem& files, const std::string& path, int fd,
                                std::uint64_t at, std::span<char> to) {
  std::size_t done = 0;
  while (done < to.size()) {
    const ssize_t got =
        files.read_at(fd, to.data() + done, to.size() - done, static_cast<off_t>(at + done));
    if (got == 0) break;
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(path, errno);
    done += static_cast<std::size_t>(got);
  }
  return done;
}

/// Hands `bytes` to put(rest) -> ssize_t until all are taken; 0, or why not.
template <class Put>
int put_all(std::string_view bytes, const Put& put) {
  while (!bytes.empty()) {
    const ssize_t taken = put(bytes);
    if (taken < 0 && errno == EINTR) continue;
    if (taken < 0) return errno;
    if (taken == 0) return ENOSPC;
    bytes.remove_prefix(static_cast<std::size_t>(taken));
  }
  return 0;
}

/// The folder of a path for open(2).
inline std::string place_of(const std::string& path) {
  return folder(path).empty() ? "." : std::string(folder(path));
}

/// So that a name in it reaches the disk; whether it did.
inline bool sync_folder(FileSystem& files, const std::string& path) {
  const int directory = files.open(place_of(path).c_str(), O_RDONLY | O_DIRECTORY, 0);
  if (directory < 0) return false;
  const bool synced = files.sync(directory) == 0;
  files.close(directory);
  return synced;
}

}  // namespace kinalign
