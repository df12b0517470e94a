// SPDX-License-Identifier: Apache-2.0
// Wrappers of single system calls for files.cpp and growing_file.cpp. They repeat interrupted
// calls, and continue short reads and writes.
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
    // A read of no bytes without an error means the end of the file. The caller compares the count.
    if (got == 0) break;
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(path, errno);
    done += static_cast<std::size_t>(got);
  }
  return done;
}

/// Calls put(rest) -> ssize_t until all bytes are written. Returns 0 or an errno.
template <class Put>
int put_all(std::string_view bytes, const Put& put) {
  while (!bytes.empty()) {
    const ssize_t taken = put(bytes);
    if (taken < 0 && errno == EINTR) continue;
    if (taken < 0) return errno;
    // A call that writes no byte would be repeated for ever, so the function reports a full disk.
    if (taken == 0) return ENOSPC;
    bytes.remove_prefix(static_cast<std::size_t>(taken));
  }
  return 0;
}

/// The folder of a path for open(2): "." if the path names no folder.
inline std::string place_of(const std::string& path) {
  return folder(path).empty() ? "." : std::string(folder(path));
}

/// Syncs the folder of a path, so that the file's name reaches the disk. Returns true on success.
/// fsync(2) of a file does not sync the file's entry in the folder. Without this call the name may
/// be missing after a power cut.
inline bool sync_folder(FileSystem& files, const std::string& path) {
  const int directory = files.open(place_of(path).c_str(), O_RDONLY | O_DIRECTORY, 0);
  if (directory < 0) return false;
  const bool synced = files.sync(directory) == 0;
  files.close(directory);
  return synced;
}

}  // namespace kinalign
