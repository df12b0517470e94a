// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bvh/copy.h"

#include "kinalign/core/unchanged.h"
#include "kinalign/formats/bvh/values.h"
#include "kinalign/formats/bvh/write.h"
#include "kinalign/formats/unknown_file.h"

namespace kinalign {

namespace {

/// A pass over the file and how it is told.
struct CopyPass {
  FileSystem& files;
  const std::string& path;
  const Progress& progress;
  std::string_view what;
};

/// Feeds a whole file; `use()` after each piece.
template <class Use>
Result<Findings> feed_file(const CopyPass& pass, BvhValues& values, Use&& use) {
  const std::string& path = pass.path;
  InputFile file = KA_TRY(InputFile::open(pass.files, path));
  Findings findings;
  bool first = true;
  std::uint64_t bytes = 0;
  for (;;) {
    const std::string_view piece = KA_TRY(file.next());
    if (std::exchange(first, false) && !looks_like_bvh(piece)) {
      return Failure(
          Error{path, 1, "a BVH or a take, which alone can become a BVH", beginning_of(piece)});
    }
    if (piece.empty()) break;
    KA_TRY(values.feed(piece, findings));
    KA_TRY(use());
    bytes += piece.size();
    if (!go_on(pass.progress, pass.what, bytes, file.size())) return Failure(interruption(path));
  }
  KA_TRY(values.finish(findings));
  KA_TRY(use());
  return findings;
}

}  // namespace

Result<Findings> copy_bvh(FileSystem& files, const std::string& from, const TextSink& sink,
                          const Progress& progress) {
  const auto version = version_of(from);
  BvhValues counted(from);
  counted.count_decimals = true;
  Findings findings =
      KA_TRY(feed_file({files, from, progress, "reading"}, counted, [&]() -> Result<void> {
        counted.drop_frames();
        return {};
      }));
  BvhWriter writer(counted.hierarchy(), counted.frames_read(), counted.decimals(), sink);
  BvhValues values(from);
  KA_TRY(feed_file({files, from, progress, "writing"}, values, [&]() -> Result<void> {
    KA_TRY(writer.append(values.frames()));
    values.drop_frames();
    return {};
  }));
  KA_TRY(unchanged(from, version));
  KA_TRY(writer.finish());
  return findings;
}

}  // namespace kinalign
