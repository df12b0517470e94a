// SPDX-License-Identifier: Apache-2.0
// A POSIX tar of regular files. The same members give the same bytes: mode 0644, time, user and
// group 0. Layout: docs/formats/webdataset.md.
#pragma once

#include "kinalign/formats/file_sink.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

class TarWriter {
 public:
  explicit TarWriter(FileSink sink) : sink_(std::move(sink)) {}

  /// Begins a member of that many bytes. Fails where the one before has other than the promised
  /// bytes, and where the name is empty, above 1000 bytes, absolute, or leads out of its folder.
  /// Above 8 GiB, and for names above 100 bytes, a pax header stands in front.
  Result<void> begin(std::string_view name, std::uint64_t size);
  /// The next bytes of the member.
  Result<void> append(std::string_view bytes);
  /// A member whose bytes are all there.
  Result<void> add(std::string_view name, std::string_view bytes);
  /// Two blocks of zeros end the archive.
  Result<void> finish();

 private:
  Result<void> end_member();
  Result<void> put(std::string_view bytes);

  FileSink sink_;
  std::string name_;
  std::uint64_t size_ = 0, left_ = 0;  // of the member
};

}  // namespace kinalign
