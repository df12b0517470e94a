// SPDX-License-Identifier: Apache-2.0
// A file that grows under its final name, for recordings. After a kill it contains all appended
// bytes, and after a power cut all synced bytes. OutputFile serves results that must be complete or
// absent.
#pragma once

#include "kinalign/core/files.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

class GrowingFile {
 public:
  /// Creates an empty file of that name without waiting for the disk. Fails if the name exists: no
  /// file is ever overwritten.
  static Result<GrowingFile> create(FileSystem& files, std::string path);
  GrowingFile(GrowingFile&&) = default;
  GrowingFile& operator=(GrowingFile&&) = delete;
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  ~GrowingFile() { close(); }

  /// Appends all bytes, or none if it fails: partly written bytes are cut off again.
  Result<void> append(std::string_view bytes);
  /// Cuts the file to an earlier size.
  Result<void> cut(std::uint64_t size);
  /// Fills `to` with the bytes from position `at` on.
  Result<void> read_at(std::uint64_t at, std::span<char> to) const;
  /// Waits until all appended bytes are on the disk. The first call also waits for the file's name.
  /// Fails if the file was removed, too. One other thread at a time may call sync() during
  /// append().
  Result<void> sync() const;
  /// Closes the file. Synced bytes are safe even if closing fails.
  void close();

  std::uint64_t size() const { return size_; }
  const std::string& path() const { return path_; }

 private:
  GrowingFile(OpenFile file, std::string path) : file_(std::move(file)), path_(std::move(path)) {}

  // The first size_ bytes of the file are those appended so far. If ragged_, bytes of a failed
  // append may follow them; the next append() or close() cuts them off.
  OpenFile file_;
  std::string path_;
  std::uint64_t size_ = 0;
  mutable bool named_ = false;  // the name has been synced
  bool ragged_ = false;         // bytes of a failed append may follow the end
};

}  // namespace kinalign
