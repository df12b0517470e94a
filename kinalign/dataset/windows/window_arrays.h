// SPDX-License-Identifier: Apache-2.0
// The arrays of a file of windows and their description.
#pragma once

#include "kinalign/dataset/windows/window_places.h"
#include "kinalign/dataset/windows/windows.h"
#include "kinalign/formats/take/take_npz.h"

#include <optional>

namespace kinalign {

/// The names of all arrays of a take that windows may have.
std::vector<std::string> window_array_names();

/// The streams of all windows, as in the first take.
struct WindowStreams {
  std::vector<TakeGroup> groups;

  /// The indices of these groups in a take. Fails with the name of a group that is missing or
  /// differs.
  Result<std::vector<std::size_t>> find_in(const TakeHeader& header) const;
  /// Notes the arrays that this take's groups, found by find_in(), have and others may lack:
  /// distances and intervals of samples.
  void add(const TakeHeader& header, const std::vector<std::size_t>& found);
};

/// A take that windows are cut from.
struct WindowedTake {
  std::size_t index = 0;                        // in the source's takes
  std::vector<std::size_t> groups;              // indices in the take, in the order of the streams
  std::vector<std::vector<Vec3>> rest_offsets;  // one list for each skeleton
  std::vector<WindowPlace> places;
};

/// The arrays of a file of windows. Their shapes must be known before the first value is written.
/// `array` of a column is its index in `arrays`.
struct WindowLayout {
  struct Column {
    std::string name;
    Stored stored;
    std::uint64_t row_values;
    std::size_t array;
  };
  std::vector<NpzArray> arrays;
  std::vector<std::pair<std::size_t, std::string>> contents;  // arrays known in advance
  std::vector<std::vector<Column>> streams;                   // arrays of rows
};
WindowLayout window_layout(const WindowSource& source, const WindowOptions& options,
                           const WindowStreams& streams, const std::vector<WindowedTake>& takes);

/// The source of a window.
struct WindowOrigin {
  std::size_t take = 0;  // index in the file's list
  std::uint8_t part = 0;
  WindowPlace place;
};

/// The file in the making. Windows are appended one after the other; all arrays grow together.
class WindowFile {
 public:
  // Writes everything that does not depend on windows: the manifest and the skeletons.
  static Result<WindowFile> create(FileSystem& files, const NewFile& target, WindowLayout layout);
  /// Appends a window. If a take lacks an array, values replace it: valid flags 1 (all rows are
  /// valid), intervals -1 (none is known), distances 0 (its rows are its own samples). `rows`: of
  /// all the take's groups, as long as a window. `groups`: the indices of the streams.
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
