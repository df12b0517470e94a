// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/motion_input.h"

#include "apps/cli/console.h"

#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/open_recording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace kinalign {

Result<std::size_t> choose_stream(const std::vector<StreamChoice>& all, const WantedStream& wanted,
                                  std::string_view kind, const std::string& path) {
  std::vector<std::string> names;
  std::vector<std::size_t> found;
  for (const StreamChoice& one : all) {
    names.push_back(one.name);
    if (wanted.name.empty() ? one.is_usual : one.name == wanted.name) found.push_back(one.index);
  }
  if (found.size() == 1) return found.front();
  const std::string expected = wanted.name.empty()
                                   ? fmt::format("one stream of {} ({} NAME)", kind, wanted.flag)
                                   : fmt::format("a stream of {} \"{}\"", kind, wanted.name);
  return Failure(
      Error{path, 0, expected, names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))});
}

Result<Input> open_motion(const std::string& path, Call& call) {
  FileSystem& files = call.surroundings.files;
  const Progress progress = call.console.progress();
  // open_input() opens everything but recordings; the manifest of a recording is made from its
  // survey.
  if (KA_TRY(kind_of_file(files, path)) != FileKind::recording) {
    return open_input(files, path, StreamFlags{}, progress);
  }
  const auto source =
      // The samples are read later, so the devices' clocks are computed, too (Devices::learned).
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
    // Notes are left out, because the summary has only a few lines.
    if (one.severity < Severity::warning) continue;
    out.push_back(to_string(one.what) + ": " + one.meaning +
                  (one.repair.empty() ? "" : "; " + one.repair));
  }
  return out;
}

}  // namespace kinalign
