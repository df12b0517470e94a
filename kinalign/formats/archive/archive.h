// SPDX-License-Identifier: Apache-2.0
// ZIP, tar and gzipped tar, read by libarchive under rules of our own: an archive can't write
// outside of its target, and a small file can't fill the disk.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

/// The archive's bytes, at any place.
struct ArchiveBytes {
  std::string name;  // for messages
  std::uint64_t size = 0;
  /// Fills `to` from byte `at` on, as far as there are any; returns how many that were.
  std::function<Result<std::size_t>(std::uint64_t at, std::span<char> to)> read_at;
};

struct ArchiveLimits {
  std::uint64_t entries = 1'000'000;
  std::uint64_t bytes = std::uint64_t{64} << 30;  // of all files
  /// Bytes of all files per byte of the archive; the first 64 MiB are not judged. Text of numbers
  /// comes to about 10, deflate can reach 1032.
  std::uint64_t ratio = 200;
};

/// The next bytes of a file in the archive; empty at its end. Valid until the next call.
using ArchivePieces = std::function<Result<std::string_view>()>;
/// Gets each file's name, "a/b.txt": relative, without "." and "..", never twice.
using UseArchiveFile = std::function<Result<void>(const std::string& name, const ArchivePieces&)>;

/// Calls `use` for each regular file, in the order of the archive. Folders are passed over. Fails,
/// with the entry's name, on a link, a device, an encrypted file, a name that is absolute, leads
/// up, has a backslash, a control character or a NUL, is too long, or that two entries have, on
/// damaged bytes, and above the limits.
Result<void> read_archive(const ArchiveBytes& bytes, const ArchiveLimits& limits,
                          const UseArchiveFile& use);

/// The name as read_archive() hands it on; fails where it is none that may be written.
Result<std::string> safe_archive_name(std::string_view name);

/// A ZIP or a tar by its first bytes, or a gzip that is called .tar.gz or .tgz.
bool looks_like_archive(std::string_view head, std::string_view path);

}  // namespace kinalign
