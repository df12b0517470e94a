// SPDX-License-Identifier: Apache-2.0
// A file that grows under its own name while it is used, so that a kill or a power cut leaves what
// was appended before: for recordings. Results that are whole or not at all are OutputFile's.
#pragma once

#include "kinalign/core/files.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

class GrowingFile {
 public:
  /// An empty file of that name; it waits for no disk. Fails where anything stands there: nothing
  /// is ever overwritten.
  static Result<GrowingFile> create(FileSystem& files, std::string path);
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&& other) noexcept;
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  ~GrowingFile();

  /// All bytes or, where it fails, none: what was written of them is cut off again.
  Result<void> append(std::string_view bytes);
  /// Back to an earlier size.
  Result<void> cut(std::uint64_t size);
  /// Fills `to` with what was appended at `at`.
  Result<void> read_at(std::uint64_t at, std::span<char> to) const;
  /// What was appended before reaches the disk, and with the first sync the name. Fails, too, where
  /// the file was removed. Another thread may call it meanwhile, one at a time.
  Result<void> sync() const;
  /// What was synced before can't be lost by it.
  void close();

  std::uint64_t size() const { return size_; }
  const std::string& path() const { return path_; }

 private:
  GrowingFile(FileSystem& files, std::string path, int fd)
      : files_(&files), path_(std::move(path)), fd_(fd) {}

  FileSystem* files_;
  std::string path_;
  int fd_;
  std::uint64_t size_ = 0;
  mutable bool named_ = false;  // on the disk
  bool ragged_ = false;         // bytes of a failed append may stand behind it
};

}  // namespace kinalign
