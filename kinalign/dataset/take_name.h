// SPDX-License-Identifier: Apache-2.0
// The name of a take in a data set, and the places of its files, similar to BIDS:
//
// sub-03/sub-03_task-S2A03_run-01_recording.toml   the manifest: raw files and parameters
// sub-03/sub-03_task-S2A03_run-01_take.h5          the take
// sub-03/sub-03_task-S2A03_run-01_take.json        its summary, with the take's SHA-256
#pragma once

#include "kinalign/core/error.h"

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// True for 1 to 64 letters and digits. BIDS allows only these in a label.
bool is_label(std::string_view text);

/// The identity of a take. Names sort by person, action and run.
struct TakeName {
  std::string subject, action;
  std::uint32_t run = 1;

  auto operator<=>(const TakeName&) const = default;
};

/// The files that a take may have.
enum class TakeFile { manifest, take, summary };

/// The name as text: "sub-03_task-S2A03_run-01".
std::string to_string(const TakeName& name);
/// Absent if `text` is no take's name. The run may have any number of digits.
std::optional<TakeName> parse_take_name(std::string_view text);

/// The path below the data set's folder: "sub-03/sub-03_task-S2A03_run-01_take.h5".
std::string path_of(const TakeName& name, TakeFile file);
/// The same path with the data set's folder before it.
std::string path_of(const std::string& folder, const TakeName& name, TakeFile file);
/// The folder of a person's takes, ending in '/', to which the paths in manifests are relative.
std::string folder_of(const std::string& folder, const TakeName& name);
/// The folder of raw files that were copied with their take: "sourcedata/sub-03/NAME/".
std::string raw_folder(const TakeName& name);
/// The inverse of path_of(): the take and the kind of a file. Absent for any other path.
std::optional<std::pair<TakeName, TakeFile>> parse_take_path(std::string_view path);

/// The places of dataset.toml and the index below the data set's folder.
inline constexpr std::string_view catalogue_file = "dataset.toml";
inline constexpr std::string_view cache_folder = ".kinalign";
inline constexpr std::string_view index_file = ".kinalign/index.sqlite";
/// The journal of a rename. It exists while takes are renamed (changes/rename.h).
inline constexpr std::string_view unfinished_rename_file = "unfinished_rename.json";

}  // namespace kinalign
