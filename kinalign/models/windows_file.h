// SPDX-License-Identifier: Apache-2.0
// Reads a file of windows (schema kinalign.windows/1, docs/windows.md) and joins windows that
// overlap to whole stretches of each take. Reads NPZ with stored (uncompressed) members, as
// kinalign and numpy.savez write it. It does not need libarchive, so that `learn` can also be built
// on a GPU machine without that library.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/numpy/npy.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// One stream's arrays in a stretch of T rows.
struct StretchStream {
  std::map<std::string, std::vector<float>> arrays;  // "positions" [T,C], "valid", "state", ...
};

/// Rows of one take between two gaps. Networks must not learn across a gap, so each stretch is a
/// separate sequence.
struct Stretch {
  std::size_t take = 0;  // index in the manifest's list of takes
  std::size_t part = 0;  // index in the manifest's list of parts
  std::size_t rows = 0;
  std::map<std::string, StretchStream> streams;
};

/// The contents of the file's manifest.
struct WindowsFacts {
  struct Take {
    std::string name, subject, action;
  };
  struct Stream {
    std::string name, kind;          // kind: skeleton, points, nodes
    std::vector<std::string> names;  // joints or nodes
    std::vector<int> parents;        // empty unless the stream is a skeleton
  };
  std::string dataset, licence, citation;
  double rate_hz = 0.0;
  std::vector<std::string> parts;  // train, validation, test; only "all" if there is no split
  std::vector<Take> takes;
  std::vector<Stream> streams;

  const Stream* find(const std::string& stream) const;
};

/// A whole file in memory. `take` and `part` of each stretch are indices into `facts`.
struct Windows {
  WindowsFacts facts;
  std::vector<Stretch> stretches;
  std::map<std::string, std::vector<float>> rest_offsets;  // by stream name: [takes,J,3] m
};

/// All arrays of an NPZ; they view the bytes of `npz`. Fails if it is not an NPZ, if a member is
/// compressed, or if a length is wrong.
Result<std::map<std::string, NpyArray>> stored_arrays(std::string_view npz,
                                                      const std::string& name);

/// `npz`: the file's bytes. Windows that overlap or follow each other are joined to one stretch.
Result<Windows> read_windows(std::string_view npz, const std::string& name);

}  // namespace kinalign
