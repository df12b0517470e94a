// SPDX-License-Identifier: Apache-2.0
// What the verbs know of their input files: flags that describe a stream, and takes that may only
// be opened in a child process.
#pragma once

#include "apps/kinalign/verb.h"

#include "kinalign/core/progress.h"
#include "kinalign/io/guarded.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// Whether a file begins as HDF5 does. Fails where it can't be read.
Result<bool> is_take(FileSystem& files, const std::string& path);

/// "name=value" in two; fails without '=' or without a name.
Result<std::pair<std::string, std::string>> split_pair(const std::string& text,
                                                       std::string_view expected);

/// Options of a single stream as flags: those of describe(StreamOptions) and --select COLUMN=VALUE.
struct StreamFlags {
  StreamOptions options;
  std::vector<std::string> select;

  Fields fields();
  /// The options with their files and selections.
  Result<StreamOptions> stream(const std::vector<std::string>& paths) const;
};

/// Reads a recording.toml; `unsaid`: what its [align] leaves open.
Result<Manifest> load_manifest(FileSystem& files, const std::string& path,
                               const AlignOptions& unsaid = {});

/// A manifest's recording, or a single stream's file as one.
Result<Recording> open_input(FileSystem& files, const std::string& path, const StreamFlags& flags,
                             const Progress& progress);

/// Fails where `out` is one of `inputs`, under whatever name: no --force replaces what was measured
/// by what is made of it.
Result<void> keep_inputs(const std::string& out, const std::vector<std::string>& inputs);

/// Every file that a manifest names; relative paths are relative to `folder`.
std::vector<std::string> files_named(const Manifest& manifest, const std::string& folder);

/// What a failed job on a take's file is blamed on, and how far it may go.
Error blame(const std::string& path);

}  // namespace kinalign
