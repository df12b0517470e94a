// SPDX-License-Identifier: Apache-2.0
// A take, or one stream alone, as NPZ, with the names of the HDF5 file: mocap_positions for
// /mocap/positions; of one stream alone plainly positions. docs/formats/take.md.
#pragma once

#include "kinalign/formats/take/npz.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

enum class NpzNames {
  by_stream,  // mocap_positions
  plain       // positions: for a header with one stream
};

class TakeNpzWriter {
 public:
  static Result<TakeNpzWriter> create(FileSystem& files, std::string path, Overwrite overwrite,
                                      const TakeHeader& header, NpzNames names);
  /// The next rows of all streams.
  Result<void> append(const TakeSlab& slab);
  /// After header.frames rows.
  Result<void> finish() { return writer_.finish(); }

 private:
  struct Column {
    std::string name;
    Stored stored;
    std::size_t array;
  };
  TakeNpzWriter(NpzWriter writer, std::vector<std::vector<Column>> groups)
      : writer_(std::move(writer)), groups_(std::move(groups)) {}

  NpzWriter writer_;
  std::vector<std::vector<Column>> groups_;
  NumberStore numbers_;
};

}  // namespace kinalign
