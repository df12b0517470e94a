// SPDX-License-Identifier: Apache-2.0
// Writes a POSIX tar of regular files. The same members give the same bytes: mode 0644; time, user
// and group 0. Layout: docs/formats/webdataset.md.
#pragma once

#include "kinalign/formats/file_sink.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

class TarWriter {
 public:
  explicit TarWriter(FileSink sink) : sink_(std::move(sink)) {}

  /// Begins a member of `size` bytes. Fails if the previous member does not have its promised
  /// bytes. Fails if the name is empty, above 1000 bytes, absolute, or leads out of its folder. A
  /// member above 8 GiB or a name above 100 bytes gets a pax header.
  Result<void> begin(std::string_view name, std::uint64_t size);
  /// The next bytes of the member.
  Result<void> append(std::string_view bytes);
  /// Writes a member whose bytes are all present.
  Result<void> add(std::string_view name, std::string_view bytes);
  /// Ends the archive with two blocks of zeros.
  Result<void> finish();

 private:
  /// A member begins at a block of 512 bytes; the last block of the one before is filled with
  /// zeros.
  Result<void> end_member();
  Result<void> put(std::string_view bytes);

  FileSink sink_;
  std::string name_;
  std::uint64_t size_ = 0, left_ = 0;  // bytes of the current member: all, and those still to come
};

}  // namespace kinalign
