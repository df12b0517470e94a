// SPDX-License-Identifier: Apache-2.0
// Files of an archive lie below its target: each name is safe and given once, and all bytes
// together stay below the limit.
#include "kinalign/dataset/import/cmu_clips.h"
#include "kinalign/formats/archive/npz.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <set>

using namespace kinalign;

namespace {

constexpr ArchiveLimits small{.entries = 100, .bytes = std::uint64_t{1} << 20};

void check_files(const ArchiveBytes& bytes) {
  std::set<std::string> names;
  std::uint64_t all = 0;
  (void)read_archive(bytes, small,
                     [&](const std::string& name, const ArchivePieces& next) -> Result<void> {
                       const auto safe = safe_archive_name(name);
                       if (!safe || *safe != name || !names.insert(name).second) std::abort();
                       for (;;) {
                         const std::string_view piece = KA_TRY(next());
                         if (piece.empty()) return {};
                         all += piece.size();
                         if (all > small.bytes) std::abort();
                       }
                     });
  if (names.size() > small.entries) std::abort();
}

void check_clips(const ArchiveBytes& bytes) {
  const auto packed = PackedClips::read(bytes);
  if (!packed) return;
  for (const PackedClip& one : packed->clips()) {
    if (one.frames < 1000 && packed->clip(one).frames.size() != one.frames) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const ArchiveBytes bytes{"fuzz", size,
                           [text](std::uint64_t at, std::span<char> to) -> Result<std::size_t> {
                             if (at >= text.size()) return std::size_t{0};
                             return text.substr(at).copy(to.data(), to.size());
                           }};
  (void)looks_like_archive(text, "a.tar.gz");
  check_files(bytes);
  if (Npz::read(bytes, small)) check_clips(bytes);
  return 0;
}
