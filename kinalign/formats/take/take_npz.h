// SPDX-License-Identifier: Apache-2.0
// Writes a take, or one stream, as a numpy NPZ file. The name mocap_positions corresponds to
// /mocap/positions in the HDF5 file; with a single stream the name is positions. See
// docs/formats/take.md.
// An NPZ file is a ZIP file of .npy members, here without compression. libzip is not used, because
// it writes the members one after the other, but a take arrives in slabs (blocks of rows) of all
// arrays. All lengths are known in advance, so every byte has a fixed position. The checksums are
// written at the end. All dates are 1980-01-01, so the same arrays give the same bytes. ZIP64 is
// used if a number needs it (APPNOTE 6.3.10, 4.3 and 4.5.3).
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"
#include "kinalign/formats/take/take_layout.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

struct NpzArray {
  std::string name;   // "positions" for numpy.load(path)["positions"]
  std::string descr;  // numpy's name of the type: "<f4", "<i8", "|u1", "<U12"
  std::uint64_t value_bytes = 0;
  std::vector<std::uint64_t> shape;  // {}: a single value

  std::uint64_t bytes() const;
};

/// The bytes before the values in a .npy file of version 1.0 (numpy/lib/format.py). The values
/// begin at a multiple of 64.
std::string npy_header(const NpzArray& array);

/// npz_numbers() describes an array of numbers. npz_texts() makes an array of texts in numpy's
/// form: UTF-32, extended with zeros.
NpzArray npz_numbers(std::string name, Stored stored, std::vector<std::uint64_t> shape);
struct NpzTexts {
  NpzArray array;
  std::string bytes;
};
NpzTexts npz_texts(std::string name, const std::vector<std::string>& texts);

/// Writes arrays. They may be appended in any order, because every position is known. Each member's
/// checksum covers the bytes appended so far.
class NpzWriter {
 public:
  /// Creates a file with these members in this order. The file at `path` appears only if finish()
  /// succeeds.
  static Result<NpzWriter> create(FileSystem& files, std::string path, Overwrite overwrite,
                                  const std::vector<NpzArray>& arrays);

  /// Appends the next bytes of the array with the index `array`.
  Result<void> append(std::size_t array, std::string_view bytes);
  /// Call this after all bytes of all arrays.
  Result<void> finish();

 private:
  struct Member {
    std::string name;
    std::uint64_t header_at = 0;  // position of the member's local header
    std::uint64_t size = 0;       // bytes of the .npy header and the values
    std::uint64_t at = 0;         // position of the next bytes
    std::uint64_t end = 0;
    std::uint32_t checksum = 0;
  };
  explicit NpzWriter(OutputFile file) : file_(std::move(file)) {}

  OutputFile file_;
  std::vector<Member> members_;
};

enum class NpzNames {
  by_stream,  // mocap_positions: stream and array
  plain       // positions: only for a single stream
};

/// Writes a take. It has the same columns as TakeWriter, but as members of a ZIP file instead of
/// data sets.
class TakeNpzWriter {
 public:
  static Result<TakeNpzWriter> create(FileSystem& files, std::string path, Overwrite overwrite,
                                      const TakeHeader& header, NpzNames names);
  /// Appends the next rows of all streams.
  Result<void> append(const TakeSlab& slab);
  /// Call this after header.frames rows.
  Result<void> finish() { return writer_.finish(); }

 private:
  struct Column {
    std::string name;
    Stored stored;
    std::size_t array;  // index of the column's member in the file
  };
  TakeNpzWriter(NpzWriter writer, std::vector<std::vector<Column>> groups)
      : writer_(std::move(writer)), groups_(std::move(groups)) {}

  NpzWriter writer_;
  std::vector<std::vector<Column>> groups_;
  NumberStore numbers_;
};

}  // namespace kinalign
