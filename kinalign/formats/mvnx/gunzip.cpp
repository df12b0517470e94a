// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/mvnx/gunzip.h"

#include <algorithm>
#include <new>

namespace kinalign {

bool looks_like_gzip(std::string_view head) { return head.starts_with("\x1f\x8b"); }

Gunzip::Gunzip() {
  // 15: the largest window. 16: a gzip header must be present.
  constexpr int gzip_alone = 15 + 16;
  if (inflateInit2(&stream_, gzip_alone) != Z_OK) throw std::bad_alloc();
}

Gunzip::~Gunzip() { inflateEnd(&stream_); }

Result<void> Gunzip::feed(std::string_view piece,
                          const std::function<Result<void>(std::string_view)>& use) {
  z_stream& s = stream_;
  while (!piece.empty()) {
    if (complete_) {  // another archive follows, as after `cat a.gz b.gz`
      if (inflateReset(&s) != Z_OK) throw std::bad_alloc();
      complete_ = false;
    }
    // zlib's sizes are 32-bit numbers.
    constexpr std::size_t most = std::size_t{1} << 30;
    const std::size_t given = std::min(piece.size(), most);
    s.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
    s.avail_in = static_cast<uInt>(given);
    int status = Z_OK;
    // Ends when the archive ends, or when the input is used and the buffer is not full.
    do {
      s.next_out = reinterpret_cast<Bytef*>(text_.data());
      s.avail_out = static_cast<uInt>(text_.size());
      status = inflate(&s, Z_NO_FLUSH);
      // The text before the damage is passed on first, so that the result does not depend on the
      // cuts between pieces.
      const std::size_t made = text_.size() - s.avail_out;
      if (made > 0) KA_TRY(use({text_.data(), made}));
      // Z_BUF_ERROR only means that more input is needed.
      if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
        return refuse("a whole gzip archive", "damaged bytes");
      }
    } while (status != Z_STREAM_END && (s.avail_in > 0 || s.avail_out == 0));
    // Further bytes belong to the next archive.
    complete_ = status == Z_STREAM_END;
    piece.remove_prefix(given - s.avail_in);
  }
  return {};
}

}  // namespace kinalign
