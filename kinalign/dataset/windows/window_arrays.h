// SPDX-License-Identifier: Apache-2.0
// The arrays of a file of windows and what it says of them.
#pragma once

#include "kinalign/dataset/windows/window_places.h"
#include "kinalign/dataset/windows/windows.h"
#include "kinalign/formats/take/take_npz.h"

#include <optional>

namespace kinalign {

/// Names of all arrays of a take that windows may have.
std::vector<std::string> window_array_names();

/// The streams of all windows, as the first take has them.
struct WindowStreams {
  std::vector<TakeGroup> groups;

  /// Which of a take's groups these are; fails, saying what is missing or another.
  Result<std::vector<std::size_t>> find_in(const TakeHeader& header) const;
  /// Takes note of what this take's groups, found by find_in(), have and others may lack: distances
  /// and intervals of samples.
  void add(const TakeHeader& header, const std::vector<std::size_t>& found);
};

/// A take that windows come from.
struct WindowedTake {
  std::size_t index = 0;                        // of the source's takes
  std::vector<std::size_t> groups;              // of the take, in the order of the streams
  std::vector<std::vector<Vec3>> rest_offsets;  // of its skeletons
  std::vector<WindowPlace> places;
};

/// The arrays of a file of windows.
struct WindowLayout {
  struct Column {
    std::string name;
    Stored stored;
    std::uint64_t row_values;
    std::size_t array;
  };
  std::vector<NpzArray> arrays;
  std::vector<std::pair<std::size_t, std::string>> contents;  // of arrays that are known before
  std::vector<std::vector<Column>> streams;                   // arrays of rows
};
WindowLayout window_layout(const WindowSource& source, const WindowOptions& options,
                           const WindowStreams& streams, const std::vector<WindowedTake>& takes);

/// Where a window comes from.
struct WindowOrigin {
  std::size_t take = 0;  // position in the file's list
  std::uint8_t part = 0;
  WindowPlace place;
};

class WindowFile {
 public:
  static Result<WindowFile> create(FileSystem& files, const NewFile& target, WindowLayout layout);
  /// A take that lacks an array has no valid flags where all rows are valid, intervals where none
  /// is known, distances where its rows are its own samples: 1, -1 and 0 stand there. `rows`: of
  /// all the take's groups, as long as a window; `groups`: which of them are the streams.
  Result<void> append(const WindowOrigin& origin, const std::vector<std::size_t>& groups,
                      const TakeSlab& rows);
  Result<void> finish() { return writer_.finish(); }

 private:
  Result<void> append_stream(const std::vector<WindowLayout::Column>& columns, std::size_t length,
                             const AnyRows& rows);
  WindowFile(NpzWriter writer, std::vector<std::vector<WindowLayout::Column>> streams)
      : writer_(std::move(writer)), streams_(std::move(streams)) {}

  NpzWriter writer_;
  std::vector<std::vector<WindowLayout::Column>> streams_;
  NumberStore numbers_;
};

}  // namespace kinalign
