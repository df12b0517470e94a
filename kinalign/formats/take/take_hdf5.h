// SPDX-License-Identifier: Apache-2.0
// Reads and writes a take as an HDF5 file, which h5py and MATLAB can open. Layout:
// docs/formats/take.md. Rows are read and written in slabs (blocks of rows), so the memory does not
// depend on the length of the take. Arrays are stored in one piece and uncompressed. Their
// positions are known before the first row. Writing takes 1.1 times as long as write() of the same
// bytes.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <memory>
#include <string>

namespace kinalign {

/// The name and version of this program as stored in a take, for example "kinalign 0.1.0".
std::string take_software();

/// Writes one take. Call create(), then append() until all rows are written, then finish(). The
/// file at `path` appears only if finish() succeeds. Otherwise no file is left. The same header,
/// slabs and report give the same bytes.
class TakeWriter {
 public:
  /// Fails if the file exists and may not be overwritten, if a name can't be stored, or if the
  /// folder can't be written. Only the part of a path within the manifest's folder is stored in the
  /// parameters.
  static Result<TakeWriter> create(FileSystem& files, std::string path, Overwrite overwrite,
                                   const TakeHeader& header);
  TakeWriter(TakeWriter&& other) noexcept;
  TakeWriter& operator=(TakeWriter&& other) noexcept;
  TakeWriter(const TakeWriter&) = delete;
  TakeWriter& operator=(const TakeWriter&) = delete;
  ~TakeWriter();

  /// Appends the next rows of all streams. They must directly follow the last slab. Allocates no
  /// memory.
  Result<void> append(const TakeSlab& slab);
  /// Call this after header.frames rows. It writes the report and then gives the file its name.
  /// Afterwards the writer must not be used.
  Result<void> finish(const AlignmentReport& report);

 private:
  struct State;
  explicit TakeWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Selects streams and arrays of a take by name. An empty list selects all.
struct TakeParts {
  std::vector<std::string> streams, arrays;
};

/// Reads a take that TakeWriter wrote: the rows in order, or any range of rows. All content of the
/// file is checked. Types, shapes and positions must fit each other and the file's length before
/// memory is allocated. Numbers must be finite, and stamps must rise. HDF5 itself may crash on a
/// hostile file, so open a file of unknown origin in a child process (guarded.h). Rows are read
/// directly from the file. HDF5 reads only the header.
class TakeReader {
 public:
  /// Opens a take. Only the selected `parts` are read. Other streams are not in the header, and
  /// other arrays are empty in each slab.
  static Result<TakeReader> open(FileSystem& files, std::string path, const TakeParts& parts = {});
  TakeReader(TakeReader&& other) noexcept;
  TakeReader& operator=(TakeReader&& other) noexcept;
  TakeReader(const TakeReader&) = delete;
  TakeReader& operator=(const TakeReader&) = delete;
  ~TakeReader();

  const TakeHeader& header() const;
  /// Name and version of the program that wrote the take, for example "kinalign 0.1.0".
  const std::string& software() const;
  /// Fills `slab` with the next rows, at most 4096 rows or 16 MiB. Returns false at the end of the
  /// take.
  Result<bool> next(TakeSlab& slab);
  /// Fills `slab` with the given rows. The position of next() stays unchanged.
  Result<void> read(std::uint64_t first, std::uint64_t count, TakeSlab& slab);
  /// The stamps of all rows.
  Result<std::vector<Time>> stamps();
  /// The report as stored in the file, with the schema kinalign.report/1 (report_json.h).
  Result<std::string> report_json() const;

 private:
  struct State;
  explicit TakeReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Reads a whole take without its report into memory, for tests and small takes.
Result<Take> read_take(FileSystem& files, const std::string& path);

}  // namespace kinalign
