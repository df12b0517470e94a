// SPDX-License-Identifier: Apache-2.0
// Reads ZIP, tar and compressed tar files with libarchive. Two rules are added: an archive can't
// write outside of its target folder, and a small archive can't fill the disk.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

/// The bytes of an archive. They must be readable at any position, because ZIP is read from its end
/// and tar from its beginning.
struct ArchiveBytes {
  std::string name;  // for messages
  std::uint64_t size = 0;
  /// Fills `to` with the bytes from position `at` on, up to the end of the archive. Returns the
  /// number of bytes.
  std::function<Result<std::size_t>(std::uint64_t at, std::span<char> to)> read_at;
};

/// Limits against hostile archives. A caller with smaller data can set smaller limits.
struct ArchiveLimits {
  /// The largest number of entries, including folders.
  std::uint64_t entries = 1'000'000;
  std::uint64_t bytes = std::uint64_t{64} << 30;  // sum over all files
  /// The largest number of bytes of all files per byte of the archive. The limit does not apply to
  /// the first 64 MiB. Tables of numbers have about 10, and the deflate method can reach 1032.
  std::uint64_t ratio = 200;
};

/// Returns the next bytes of a file in the archive; empty at its end. They are valid until the next
/// call.
using ArchivePieces = std::function<Result<std::string_view>()>;
/// Called for each file. `name` is relative, such as "a/b.txt", without "." and "..", and occurs
/// once. The function may read the pieces up to their end or ignore them.
using UseArchiveFile = std::function<Result<void>(const std::string& name, const ArchivePieces&)>;

/// Calls `use` for each regular file, in the order of the archive. Folders are skipped. Fails for a
/// link, a device, an encrypted file, damaged bytes, an exceeded limit, or a bad name. The error
/// names the entry. A bad name is absolute, leads upwards, contains a backslash, a control
/// character or a NUL, is too long, or occurs twice.
Result<void> read_archive(const ArchiveBytes& bytes, const ArchiveLimits& limits,
                          const UseArchiveFile& use);

/// The name that read_archive() passes to `use`. Fails if a file with that name must not be
/// written.
Result<std::string> safe_archive_name(std::string_view name);

/// True for the first bytes of a ZIP or tar file. Also true for the first bytes of a gzip file if
/// the path ends in .tar.gz or .tgz.
bool looks_like_archive(std::string_view head, std::string_view path);

}  // namespace kinalign
