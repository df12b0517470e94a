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
  // Opening parses and hashes whole files. The memory that it used lies free in the allocator and
  // would count until the end.
  malloc_trim(0);  // returns the memory freed after opening the recording to the system
  std::optional<TakeWriter> writer;
  TakeSink sink;
  // The writer is created when the header is known. A plan that fails therefore leaves no temporary
  // file.
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
  // finish() adds the report, syncs the file and gives it its final name.
  if (writer) KA_TRY(writer->finish(report));
  return report;
}

}  // namespace kinalign
