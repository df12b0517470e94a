// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/bvh_copy.h"

#include "kinalign/core/file_version.h"
#include "kinalign/io/bvh_values.h"
#include "kinalign/io/bvh_write.h"
#include "kinalign/io/unknown_file.h"

namespace kinalign {

namespace {

/// Feeds a whole file; `use()` after each piece.
template <class Use>
Result<void> feed_file(FileSystem& files, const std::string& path, BvhValues& values,
                       Findings& findings, Use&& use) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  bool first = true;
  for (;;) {
    const std::string_view piece = KA_TRY(file.next());
    if (std::exchange(first, false) && !looks_like_bvh(piece)) {
      return Failure(
          Error{path, 1, "a BVH or a take, which alone can become a BVH", beginning_of(piece)});
    }
    if (piece.empty()) break;
    KA_TRY(values.feed(piece, findings));
    KA_TRY(use());
  }
  KA_TRY(values.finish(findings));
  return use();
}

}  // namespace

Result<Findings> copy_bvh(FileSystem& files, const std::string& from, const TextSink& sink) {
  const auto version = version_of(from);
  Findings findings;
  BvhValues counted(from);
  counted.count_decimals = true;
  KA_TRY(feed_file(files, from, counted, findings, [&]() -> Result<void> {
    counted.drop_frames();
    return {};
  }));
  BvhWriter writer(counted.hierarchy(), counted.frames_read(), counted.decimals(), sink);
  BvhValues values(from);
  Findings again;
  KA_TRY(feed_file(files, from, values, again, [&]() -> Result<void> {
    KA_TRY(writer.append(values.frames()));
    values.drop_frames();
    return {};
  }));
  if (version_of(from) != version) {
    return Failure(
        Error{from, 0, "a file that stays as it is while it is read", "one that changed"});
  }
  KA_TRY(writer.finish());
  return findings;
}

}  // namespace kinalign
