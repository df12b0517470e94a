// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs/align_job.h"

#include "apps/cli/console.h"

#include "kinalign/align/align.h"
#include "kinalign/formats/take/take_hdf5.h"

#include <malloc.h>

#include <optional>

namespace kinalign {

Result<AlignmentReport> align_to_file(const Call& call, const Recording& recording,
                                      const Manifest& manifest, const TakeTarget& target) {
  // Opening parses and hashes whole files. The allocator keeps the memory that was used for it,
  // which would count until the end.
  malloc_trim(0);  // gives free memory back to the system
  std::optional<TakeWriter> writer;
  TakeSink sink;
  // The file is created when the header is known, so that an error before leaves no temporary file.
  sink.begin = [&](const TakeHeader& header) -> Result<void> {
    if (target.path.empty()) return {};
    writer.emplace(
        KA_TRY(TakeWriter::create(call.surroundings.files, target.path, target.overwrite, header)));
    return {};
  };
  sink.rows = [&](const TakeSlab& slab) -> Result<void> {
    return writer ? writer->append(slab) : Result<void>{};
  };
  AlignmentReport report =
      KA_TRY(align(recording, manifest, sink, call.console.progress(), call.jobs));
  // finish() adds the report, writes all data to the disk and gives the file its final name.
  if (writer) KA_TRY(writer->finish(report));
  return report;
}

}  // namespace kinalign
