// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/mvnx/gunzip.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>

namespace kinalign {

/// zlib's state, and the buffer for unpacked text.
struct Gunzip::State {
  z_stream stream{};
  bool complete = false;
  std::array<char, std::size_t{64} << 10> text{};
};

bool looks_like_gzip(std::string_view head) { return head.starts_with("\x1f\x8b"); }

Gunzip::Gunzip() : state_(std::make_unique<State>()) {
  // 15: the largest window. 16: a gzip header is required.
  constexpr int gzip_alone = 15 + 16;
  if (inflateInit2(&state_->stream, gzip_alone) != Z_OK) throw std::bad_alloc();
}

Gunzip::~Gunzip() { inflateEnd(&state_->stream); }

bool Gunzip::complete() const { return state_->complete; }

Result<void> Gunzip::feed(std::string_view piece,
                          const std::function<Result<void>(std::string_view)>& use) {
  z_stream& s = state_->stream;
  auto& text = state_->text;
  while (!piece.empty()) {
    if (state_->complete) {  // another archive follows, as in the output of `cat a.gz b.gz`
      if (inflateReset(&s) != Z_OK) throw std::bad_alloc();
      state_->complete = false;
    }
    // zlib's sizes are 32-bit numbers.
    constexpr std::size_t most = std::size_t{1} << 30;
    const std::size_t given = std::min(piece.size(), most);
    s.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
    s.avail_in = static_cast<uInt>(given);
    int status = Z_OK;
    // Until the archive ends or the input is used up and the buffer was not filled.
    do {
      s.next_out = reinterpret_cast<Bytef*>(text.data());
      s.avail_out = static_cast<uInt>(text.size());
      status = inflate(&s, Z_NO_FLUSH);
      // The text before the damage goes to the user first, so the result does not depend on how the
      // file is cut into pieces.
      const std::size_t made = text.size() - s.avail_out;
      if (made > 0) KA_TRY(use({text.data(), made}));
      // Z_BUF_ERROR only means that more input is needed.
      if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
        return Failure(Error{"", 0, "a whole gzip archive", "damaged bytes"});
      }
    } while (status != Z_STREAM_END && (s.avail_in > 0 || s.avail_out == 0));
    // Bytes that follow belong to the next archive.
    state_->complete = status == Z_STREAM_END;
    piece.remove_prefix(given - s.avail_in);
  }
  return {};
}

}  // namespace kinalign
