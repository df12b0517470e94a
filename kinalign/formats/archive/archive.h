// SPDX-License-Identifier: Apache-2.0
// ZIP, tar and gzipped tar, read by libarchive under two rules of our own: an archive can't write
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

/// The bytes of an archive, which can be read from any position.
/// ZIP is read from its end and tar from its front, so the bytes must be readable at any position.
struct ArchiveBytes {
  std::string name;  // for messages
  std::uint64_t size = 0;
  /// Fills `to` with the bytes from position `at` on, up to the end. Returns the number of bytes
  /// read.
  std::function<Result<std::size_t>(std::uint64_t at, std::span<char> to)> read_at;
};

/// The defaults are limits against hostile archives; a caller with smaller data gives smaller ones.
struct ArchiveLimits {
  /// Most entries, folders included.
  std::uint64_t entries = 1'000'000;
  std::uint64_t bytes = std::uint64_t{64} << 30;  // all files together
  /// Most bytes of all files per byte of the archive. The first 64 MiB are exempt. Tables of
  /// numbers reach about 10; deflate can reach 1032.
  std::uint64_t ratio = 200;
};

/// Returns the next bytes of a file in the archive; empty at its end. Valid until the next call.
using ArchivePieces = std::function<Result<std::string_view>()>;
/// Called with the name of each file, such as "a/b.txt": relative, without "." and "..", each name
/// once.
/// `use` may read the pieces to their end or ignore them.
using UseArchiveFile = std::function<Result<void>(const std::string& name, const ArchivePieces&)>;

/// Calls `use` for each regular file, in the order of the archive. Folders are skipped. Fails, with
/// the entry's name, on: a link, a device, an encrypted file, damaged bytes, exceeded limits, and a
/// bad name. A bad name is absolute, leads up, has a backslash, a control character or a NUL, is
/// too long, or occurs twice.
Result<void> read_archive(const ArchiveBytes& bytes, const ArchiveLimits& limits,
                          const UseArchiveFile& use);

/// The name as read_archive() passes it to `use`. Fails if a file of that name may not be written.
Result<std::string> safe_archive_name(std::string_view name);

/// True if the first bytes are those of a ZIP or a tar, or those of a gzip whose path ends in
/// .tar.gz or .tgz.
bool looks_like_archive(std::string_view head, std::string_view path);

}  // namespace kinalign
