// SPDX-License-Identifier: Apache-2.0
// Wrappers of single system calls for files.cpp and growing_file.cpp. Interrupted calls are
// repeated, and short reads and writes continue.
#pragma once

#include "kinalign/core/files.h"

#include <fcntl.h>

#include <cerrno>
#include <cstring>

namespace kinalign {

inline Failure failed(const std::string& path, std::string expected, int code) {
  return refuse(path, std::move(expected), std::strerror(code));
}

/// The error for a file that could not be opened or read.
inline Failure unreadable(const std::string& path, int code) {
  // The advice for a failing disk differs from that for other errors (apps/cli/file_advice.cpp).
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
    // No byte without an error: the file ends here. The caller compares the count.
    if (got == 0) break;
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(path, errno);
    done += static_cast<std::size_t>(got);
  }
  return done;
}

/// Calls put(rest) -> ssize_t until all bytes are taken. Returns 0 or an errno.
template <class Put>
int put_all(std::string_view bytes, const Put& put) {
  while (!bytes.empty()) {
    const ssize_t taken = put(bytes);
    if (taken < 0 && errno == EINTR) continue;
    if (taken < 0) return errno;
    // A call that takes no byte would be repeated for ever, so it counts as a full disk.
    if (taken == 0) return ENOSPC;
    bytes.remove_prefix(static_cast<std::size_t>(taken));
  }
  return 0;
}

/// The folder of a path in a form for open(2).
/// A path without a folder names a file in the working directory.
inline std::string place_of(const std::string& path) {
  return folder(path).empty() ? "." : std::string(folder(path));
}

/// Syncs the folder of a path, so that the file's name reaches the disk; true if it succeeded.
/// fsync(2) of a file does not sync the entry in its folder; without this call the name may be
/// lost.
inline bool sync_folder(FileSystem& files, const std::string& path) {
  const int directory = files.open(place_of(path).c_str(), O_RDONLY | O_DIRECTORY, 0);
  if (directory < 0) return false;
  const bool synced = files.sync(directory) == 0;
  files.close(directory);
  return synced;
}

}  // namespace kinalign
