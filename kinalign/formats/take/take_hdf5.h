// SPDX-License-Identifier: Apache-2.0
// Reads and writes a take as an HDF5 file that h5py and MATLAB can open. Layout:
// docs/formats/take.md. Rows are written and read in slabs, so memory does not depend on the take's
// length. Arrays are stored whole and uncompressed, at positions that are known before the first
// row. Writing takes 1.1 times as long as write() of the same bytes.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <memory>
#include <string>

namespace kinalign {

/// The software name and version that this program stores in a take: "kinalign 0.1.0".
std::string take_software();

/// Writes one take. The file at `path` appears only when finish() has succeeded. The same header,
/// slabs and report give the same bytes.
/// Order of calls: create(), append() until all rows are written, finish(). Nothing is left of a
/// writer that is destroyed before.
class TakeWriter {
 public:
  /// Fails if the file exists and may not be overwritten, if a name can't be stored, or if the
  /// folder can't be written. Paths in the parameters keep only the part within the manifest's
  /// folder.
  static Result<TakeWriter> create(FileSystem& files, std::string path, Overwrite overwrite,
                                   const TakeHeader& header);
  TakeWriter(TakeWriter&& other) noexcept;
  TakeWriter& operator=(TakeWriter&& other) noexcept;
  TakeWriter(const TakeWriter&) = delete;
  TakeWriter& operator=(const TakeWriter&) = delete;
  ~TakeWriter();

  /// Appends the next rows of all streams. They must follow the last slab. Allocates nothing.
  Result<void> append(const TakeSlab& slab);
  /// Call after header.frames rows. Writes the report, then gives the file its name. The writer
  /// can't be used afterwards.
  Result<void> finish(const AlignmentReport& report);

 private:
  struct State;
  explicit TakeWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Selection of a take's streams and arrays, by name. An empty list selects all.
struct TakeParts {
  std::vector<std::string> streams, arrays;
};

/// Reads a take that TakeWriter wrote, in order of rows or any window of rows. Nothing in the file
/// is trusted. Types, shapes and positions are checked against each other and against the file's
/// length before anything is allocated. Numbers must be finite and stamps must rise. HDF5 itself
/// can crash on a hostile file: open a file of unknown origin in a child process (guarded.h).
/// Rows are read straight from the file; HDF5 is used for the header only.
class TakeReader {
 public:
  /// Opens a take. Only the selected `parts` are read: other streams are not in the header, other
  /// arrays are empty in a slab.
  static Result<TakeReader> open(FileSystem& files, std::string path, const TakeParts& parts = {});
  TakeReader(TakeReader&& other) noexcept;
  TakeReader& operator=(TakeReader&& other) noexcept;
  TakeReader(const TakeReader&) = delete;
  TakeReader& operator=(const TakeReader&) = delete;
  ~TakeReader();

  const TakeHeader& header() const;
  /// Name and version of the program that wrote the take: "kinalign 0.1.0".
  const std::string& software() const;
  /// Fills the next slab, of at most 4096 rows or 16 MiB; false at the end.
  Result<bool> next(TakeSlab& slab);
  /// Fills `slab` with the given rows; does not change the position of next().
  Result<void> read(std::uint64_t first, std::uint64_t count, TakeSlab& slab);
  /// The stamps of all rows.
  Result<std::vector<Time>> stamps();
  /// The report as stored in the file, schema kinalign.report/1 (report_json.h).
  Result<std::string> report_json() const;

 private:
  struct State;
  explicit TakeReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Reads a whole take into memory, without its report: for tests and small jobs.
Result<Take> read_take(FileSystem& files, const std::string& path);

}  // namespace kinalign
