// SPDX-License-Identifier: Apache-2.0
// Decompresses a gzip file (RFC 1952) in pieces.
#pragma once

#include "kinalign/core/error.h"

#include <zlib.h>

#include <array>
#include <functional>
#include <string_view>

namespace kinalign {

bool looks_like_gzip(std::string_view head);

/// Decompresses the bytes of a file. If the file contains several archives, their texts are joined.
class Gunzip {
 public:
  Gunzip();
  ~Gunzip();
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;

  /// Calls `use(text)` for pieces of at most 64 KiB. Fails if the bytes are damaged or if `use`
  /// fails. The caller adds the file to the error.
  Result<void> feed(std::string_view piece,
                    const std::function<Result<void>(std::string_view)>& use);

  /// True if the last archive in the file is complete.
  bool complete() const { return complete_; }

 private:
  z_stream stream_{};
  bool complete_ = false;
  std::array<char, std::size_t{64} << 10> text_{};  // buffer for the decompressed text
};

}  // namespace kinalign
