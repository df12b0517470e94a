// SPDX-License-Identifier: Apache-2.0
// The arrays of a file of windows and their description.
#pragma once

#include "kinalign/dataset/windows/window_places.h"
#include "kinalign/dataset/windows/windows.h"
#include "kinalign/formats/take/take_npz.h"

#include <optional>

namespace kinalign {

/// The names of all arrays of a take that windows can contain.
std::vector<std::string> window_array_names();

/// The streams of all windows. They are the streams of the first take.
struct WindowStreams {
  std::vector<TakeGroup> groups;

  /// The indices of these streams in a take. If a stream is missing or differs, this fails with its
  /// name.
  Result<std::vector<std::size_t>> find_in(const TakeHeader& header) const;
  /// Notes which optional arrays this take has (distances and intervals of samples), in its groups
  /// that find_in() found.
  void add(const TakeHeader& header, const std::vector<std::size_t>& found);
};

/// A take from which windows are cut.
struct WindowedTake {
  std::size_t index = 0;  // indices of the groups in the take, in the order of the streams
  std::vector<std::size_t> groups;              // indices in the take, in the order of the streams
  std::vector<std::vector<Vec3>> rest_offsets;  // one list for each skeleton
  std::vector<WindowPlace> places;
};

/// The arrays of a file of windows. Their shapes must be known before the first value is written.
/// `Column::array` is an index into `arrays`.
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

/// The take, the part and the place of a window.
struct WindowOrigin {
  std::size_t take = 0;  // index in the file's list of takes
  std::uint8_t part = 0;
  WindowPlace place;
};

/// A file of windows while it is written. Windows are appended one after the other to all arrays.
class WindowFile {
 public:
  // Writes all arrays that do not depend on windows: the manifest and the skeletons.
  static Result<WindowFile> create(FileSystem& files, const NewFile& target, WindowLayout layout);
  /// Appends a window. If a take lacks an array, it gets fixed values: valid flags 1 (all rows are
  /// valid), intervals -1 (not known), distances 0 (rows are original samples). `rows`: the rows of
  /// all groups of the take, as long as a window. `groups`: the indices of the streams in the take.
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
