// SPDX-License-Identifier: Apache-2.0
// The name of a take in a data set, and where its files lie, in the manner of BIDS:
//
//   sub-03/sub-03_task-S2A03_run-01_recording.toml   how it is made: a manifest of raw files
//   sub-03/sub-03_task-S2A03_run-01_take.h5          the take
//   sub-03/sub-03_task-S2A03_run-01_take.json        what is known of it, and its SHA-256
#pragma once

#include "kinalign/core/error.h"

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Letters and digits, at least one and at most 64: what BIDS allows in a label.
bool is_label(std::string_view text);

struct TakeName {
  std::string subject, action;
  std::uint32_t run = 1;

  auto operator<=>(const TakeName&) const = default;
};

enum class TakeFile { manifest, take, summary };

/// "sub-03_task-S2A03_run-01".
std::string to_string(const TakeName& name);
/// Absent where `text` is none; any number of digits for the run.
std::optional<TakeName> parse_take_name(std::string_view text);

/// "sub-03/sub-03_task-S2A03_run-01_take.h5", below the data set's folder.
std::string path_of(const TakeName& name, TakeFile file);
/// "sourcedata/sub-03/NAME/": raw files that were copied with their take.
std::string raw_folder(const TakeName& name);
/// The name and kind of a file that lies where path_of() puts it; absent for any other path.
std::optional<std::pair<TakeName, TakeFile>> parse_take_path(std::string_view path);

/// Where dataset.toml and the index lie, below the data set's folder.
inline constexpr std::string_view catalogue_file = "dataset.toml";
inline constexpr std::string_view cache_folder = ".kinalign";
inline constexpr std::string_view index_file = ".kinalign/index.sqlite";
/// There while takes are renamed (changes/rename.h).
inline constexpr std::string_view unfinished_rename_file = "unfinished_rename.json";

}  // namespace kinalign
