// SPDX-License-Identifier: Apache-2.0
// The input files of verbs: the flags that describe a stream, opening, and checks of file names.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/core/progress.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/recording/survey.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// Splits "name=value" in two. Fails without '=' or without a name.
Result<std::pair<std::string, std::string>> split_pair(const std::string& text,
                                                       std::string_view expected);

/// The options of a single stream as flags: those members of describe(StreamOptions) that its
/// reader uses, and --select COLUMN=VALUE.
/// The flag values live in this structure, so it must outlive the Fields that fields() returns.
struct StreamFlags {
  StreamOptions options;
  std::vector<std::string> select;  // COLUMN=VALUE

  Fields fields();
  /// Refuses the call (exit code 2) if a flag does not apply to the file. `stream`: the file's
  /// stream; nullptr for a take, a manifest or a recording.
  Result<void> check_use(const std::string& path, const RecordedStream* stream, Call& call) const;
  /// The options with their files and selections.
  Result<StreamOptions> stream(const std::vector<std::string>& paths) const;
};

/// Reads a recording.toml. `unsaid`: the values of options that its [align] does not state.
Result<Manifest> load_manifest(FileSystem& files, const std::string& path,
                               const AlignOptions& unsaid = {});

/// The manifest of the recording that begins in `path`. It names the file relative to its folder.
Result<Manifest> recorded_manifest(const RecordingSurvey& survey, const std::string& path);

/// The recording of a manifest, or of a single stream's file.
/// The result of open_input(). Its streams read their files through the FileSystem of the call,
/// which must outlive it.
struct Input {
  Recording recording;
  std::optional<Manifest> manifest;  // absent for a single stream's file
};
Result<Input> open_input(FileSystem& files, const std::string& path, const StreamFlags& flags,
                         const Progress& progress);

/// The exit code of a job that was done: 1 if there is a warning or an error, 0 if there are only
/// notes.
int code_of(const Findings& findings);

/// Fails if a take would get the ending of another format.
Result<void> check_take_name(const std::string& out);

/// Advice on where to look up names, for an error about an unknown joint or node; else empty.
std::string name_advice(const Error& error);

/// The position of the first byte that differs; absent if two files are the same.
Result<std::optional<std::uint64_t>> first_difference(FileSystem& files, const std::string& a,
                                                      const std::string& b);

/// Fails if `out` is the same file as one of `inputs`, also under another name. Even --force must
/// not replace a measurement by a file made from it.
Result<void> keep_inputs(const std::string& out, const std::vector<std::string>& inputs);

/// The folder that all paths of a manifest share: "" or ending in '/'. The paths become relative to
/// it, so that a take depends neither on the current folder nor on the spelling of a path. If they
/// share no folder they become absolute.
std::string cut_common_folder(Manifest& manifest);

/// Every file that a manifest names; relative paths are relative to `folder`.
std::vector<std::string> files_named(Manifest manifest, const std::string& folder);

}  // namespace kinalign
