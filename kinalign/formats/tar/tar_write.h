// SPDX-License-Identifier: Apache-2.0
// Writes a POSIX tar file of regular files. The same members give the same bytes, because mode
// (0644), time, user and group (0) are fixed. Layout: docs/formats/webdataset.md.
#pragma once

#include "kinalign/formats/file_sink.h"

#include <string_view>

namespace kinalign {

class TarWriter {
 public:
  explicit TarWriter(FileSink sink) : sink_(std::move(sink)) {}

  /// Writes a member. Fails if the name is empty, longer than 1000 bytes, absolute, or leads out of
  /// its folder. A member above 8 GiB or a name above 100 bytes gets a pax header.
  Result<void> add(std::string_view name, std::string_view bytes);
  /// Ends the archive with two blocks of zeros.
  Result<void> finish();

 private:
  Result<void> put(std::string_view bytes);

  FileSink sink_;
};

}  // namespace kinalign
