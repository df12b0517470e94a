// SPDX-License-Identifier: Apache-2.0
// What the verbs know of their input files: flags that describe a stream, and takes that may only
// be opened in a child process.
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

/// "name=value" in two; fails without '=' or without a name.
Result<std::pair<std::string, std::string>> split_pair(const std::string& text,
                                                       std::string_view expected);

/// Options of a single stream as flags: those of describe(StreamOptions) that its reader uses, and
/// --select COLUMN=VALUE.
struct StreamFlags {
  StreamOptions options;
  std::vector<std::string> select;

  Fields fields();
  /// The failure of a flag that the file has no use for: of a stream, or (nullptr) of a take or a
  /// manifest.
  Result<void> check_use(const std::string& path, const RecordedStream* stream,
                         const Sources& given) const;
  /// The options with their files and selections.
  Result<StreamOptions> stream(const std::vector<std::string>& paths) const;
};

/// Reads a recording.toml; `unsaid`: what its [align] leaves open.
Result<Manifest> load_manifest(FileSystem& files, const std::string& path,
                               const AlignOptions& unsaid = {});

/// Of the recording that begins in `path`, which it names as its folder has it.
Result<Manifest> recorded_manifest(const RecordingSurvey& survey, const std::string& path);

/// A manifest's recording, or a single stream's file as one.
struct Input {
  Recording recording;
  std::optional<Manifest> manifest;
};
Result<Input> open_input(FileSystem& files, const std::string& path, const StreamFlags& flags,
                         const Progress& progress);

/// The exit code of a job that was done: 1 where a warning or an error was found, notes are none.
int code_of(const Findings& findings);

/// Fails where a take would get the ending of another format.
Result<void> check_take_name(const std::string& out);

/// Where the names stand, for an error about a joint or a node that is not there; else empty.
std::string name_advice(const Error& error);

/// Byte of the first difference; nothing where two files are the same.
Result<std::optional<std::uint64_t>> first_difference(FileSystem& files, const std::string& a,
                                                      const std::string& b);

/// Fails where `out` is one of `inputs`, under whatever name: no --force replaces what was measured
/// by what is made of it.
Result<void> keep_inputs(const std::string& out, const std::vector<std::string>& inputs);

/// The folder that all paths of a manifest share, "" or ending in '/'; they become relative to it,
/// so that a take does not depend on where the program was called from, nor on how a path is spelt.
/// Where they share nothing they become absolute.
std::string cut_common_folder(Manifest& manifest);

/// Every file that a manifest names; relative paths are relative to `folder`.
std::vector<std::string> files_named(Manifest manifest, const std::string& folder);

}  // namespace kinalign
