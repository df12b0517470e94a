// SPDX-License-Identifier: Apache-2.0
// Cuts windows from a data set's takes into arrays for training: one NPZ (docs/windows.md), schema
// kinalign.windows/1.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/options.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/dataset/take_summary.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The choices of the user; docs/windows.md explains them.
struct WindowOptions {
  std::int64_t length = 64, step = 32;  // rows
  double rate_hz = 0.0;                 // 0: the rate of the takes, which must be the same for all
  double valid = 0.5;  // least share of valid cells that each stream of a window must have
  std::vector<std::string> streams;  // empty: those that all takes have
};

/// A take to cut, with its part of the split as an index in WindowSource::parts.
struct WindowTake {
  TakeName name;
  std::string class_id;
  TakeSummary summary;
  std::uint8_t part = 0;
};

/// The takes, and the facts about their data set that are written into the file.
struct WindowSource {
  std::string folder;                   // of the data set
  std::string name, licence, citation;  // of the data set
  std::vector<std::string> parts;       // of the split; only "all" without a split
  std::vector<WindowTake> takes;
};

/// A take without windows, with the reason in words.
struct TakeLeftOut {
  TakeName name;
  std::string why;
};

/// The counts of windows and of left-out data, for the user.
struct WindowsMade {
  std::vector<std::uint64_t> windows;  // for each part
  std::uint64_t rows_left_out = 0;     // rows of takes in stretches shorter than half a window
  std::uint64_t too_little_valid = 0;  // windows left out because of too few valid cells
  std::vector<TakeLeftOut> takes_left_out;
};

/// The file to write, and whether an older one may be replaced.
struct NewFile {
  std::string path;
  Overwrite overwrite = Overwrite::no;
};

/// Writes `target` in a child process, because HDF5 can crash on a hostile file. Takes are left out
/// if they lack a stream, if their streams are in other spaces than in most takes, or if their
/// joints or nodes differ from those of the first take in these spaces. Fails if rates differ and
/// `rate_hz` is 0, if no stream is in all takes, or if no window is left.
Result<WindowsMade> write_windows(FileSystem& files, const WindowSource& source,
                                  const WindowOptions& options, const NewFile& target,
                                  const Progress& progress);

}  // namespace kinalign
