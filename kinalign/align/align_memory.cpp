// SPDX-License-Identifier: Apache-2.0
// Aligns a recording into memory: collects the slabs in a Take.
#include "kinalign/align/align.h"

namespace kinalign {

Result<Take> align(const Recording& recording, const Manifest& manifest) {
  Take take;
  TakeSink sink;
  sink.begin = [&take](const TakeHeader& header) -> Result<void> {
    take.header = header;
    return {};
  };
  // The slab is reused for the next rows, so its rows are copied.
  sink.rows = [&take](const TakeSlab& slab) -> Result<void> {
    append_rows(take.all, slab);
    return {};
  };
  take.report = KA_TRY(align(recording, manifest, sink));
  return take;
}

}  // namespace kinalign
