// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/motion_input.h"

#include "apps/cli/console.h"

#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/open_recording.h"

#include <utility>

namespace kinalign {

Result<Input> open_motion(const std::string& path, Call& call) {
  FileSystem& files = call.surroundings.files;
  const Progress progress = call.console.progress();
  // Only a recording needs more than open_input(): its manifest is made from its survey.
  if (KA_TRY(kind_of_file(files, path)) != FileKind::recording) {
    return open_input(files, path, StreamFlags{}, progress);
  }
  const auto source =
      // Devices::learned also fits the devices' clocks, since the samples are read.
      KA_TRY(RecordingSource::open(files, path, RecordingSource::Devices::learned, {}, progress));
  Input out;
  out.manifest = KA_TRY(recorded_manifest(source->survey(), path));
  OpenedInPart opened =
      KA_TRY(open_what_can_be(files, *out.manifest, std::string(folder(path)),
                              {.progress = progress, .jobs = call.jobs, .recording = source}));
  out.recording = std::move(opened.recording);
  return out;
}

std::vector<std::string> warnings_of(const RecordedStream& stream) {
  std::vector<std::string> out;
  for (const Finding& one : all_findings(stream)) {
    // Notes are of no use in a summary of a few lines.
    if (one.severity < Severity::warning) continue;
    out.push_back(to_string(one.what) + ": " + one.meaning +
                  (one.repair.empty() ? "" : "; " + one.repair));
  }
  return out;
}

}  // namespace kinalign
