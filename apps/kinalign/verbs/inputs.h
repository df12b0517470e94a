// SPDX-License-Identifier: Apache-2.0
// The input files of verbs: the flags that describe a stream, opening files, and checks of file
// names.
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

/// Splits "name=value" in two. Fails if '=', the name or the value is missing.
Result<std::pair<std::string, std::string>> split_pair(const std::string& text,
                                                       std::string_view expected);

/// The options of a single stream as flags: those members of describe(StreamOptions) that the
/// stream's reader uses, and --select COLUMN=VALUE. The structure has the values of the flags, so
/// it must live longer than the Fields from fields().
struct StreamFlags {
  StreamOptions options;
  std::vector<std::string> select;  // COLUMN=VALUE

  Fields fields();
  /// Refuses the call (exit code 2) if a flag does not apply to the file. `stream`: the stream of
  /// the file; nullptr for a take, a manifest or a recording.
  Result<void> check_use(const std::string& path, const RecordedStream* stream, Call& call) const;
  /// The options of a stream that is read from these files.
  Result<StreamOptions> stream(const std::vector<std::string>& paths) const;
};

/// Reads a recording.toml. `unsaid`: the values of options that the file's [align] does not state.
Result<Manifest> load_manifest(FileSystem& files, const std::string& path,
                               const AlignOptions& unsaid = {});

/// The manifest for a recording whose first file is `path`. It names the file relative to its
/// folder.
Result<Manifest> recorded_manifest(const RecordingSurvey& survey, const std::string& path);

/// An open recording: that of a manifest, or one made from a single stream's file. Its streams read
/// their files through the FileSystem of open_input(), which must live longer.
struct Input {
  Recording recording;
  std::optional<Manifest> manifest;  // empty for a single stream's file
};
Result<Input> open_input(FileSystem& files, const std::string& path, const StreamFlags& flags,
                         const Progress& progress);

/// The exit code of a verb that has done its work: 1 if a finding is a warning or an error, else 0.
int code_of(const Findings& findings);

/// Fails if the name of a new take has the ending of another format.
Result<void> check_take_name(const std::string& out);

/// For an error about an unknown joint or node: advice on where to look up the names. Empty for
/// other errors.
std::string name_advice(const Error& error);

/// The position of the first byte in which two files differ. Empty if the files are equal.
Result<std::optional<std::uint64_t>> first_difference(FileSystem& files, const std::string& a,
                                                      const std::string& b);

/// Fails if `out` is one of the files `inputs`, even under another name. Even --force must not
/// replace a measurement by a file that was made from it.
Result<void> keep_inputs(const std::string& out, const std::vector<std::string>& inputs);

/// Removes from all paths of a manifest the folder that they share, and returns this folder: "" or
/// ending in '/'. A take then does not depend on the current folder or the spelling of a path. If
/// the paths share no folder, they become absolute.
std::string cut_common_folder(Manifest& manifest);

/// Every file that a manifest names. Relative paths are relative to `folder`.
std::vector<std::string> files_named(Manifest manifest, const std::string& folder);

}  // namespace kinalign
