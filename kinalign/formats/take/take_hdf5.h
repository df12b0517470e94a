// SPDX-License-Identifier: Apache-2.0
// A take as an HDF5 file that h5py and MATLAB open. Layout: docs/formats/take.md. Written and read
// in slabs of rows, so memory does not go by the take's length. Arrays lie whole and uncompressed
// in the file, at places that are known before the first row: 1.1 times write() of the same bytes.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <memory>
#include <string>

namespace kinalign {

/// What takes of this program say as their software: "kinalign 0.1.0".
std::string take_software();

/// Writes one take. Nothing stands at `path` until finish() has succeeded. The same header, slabs
/// and report give the same bytes.
class TakeWriter {
 public:
  /// Fails where the file is there and may not be overwritten, where a name can't be stored, or
  /// where the folder can't be written. Of paths in the parameters only the part that does not
  /// lead out of the manifest's folder is kept.
  static Result<TakeWriter> create(FileSystem& files, std::string path, Overwrite overwrite,
                                   const TakeHeader& header);
  TakeWriter(TakeWriter&& other) noexcept;
  TakeWriter& operator=(TakeWriter&& other) noexcept;
  TakeWriter(const TakeWriter&) = delete;
  TakeWriter& operator=(const TakeWriter&) = delete;
  ~TakeWriter();

  /// The next rows of all streams: those behind the last slab's. Allocates nothing.
  Result<void> append(const TakeSlab& slab);
  /// After header.frames rows: the report, then the file takes its name. The writer is used up.
  Result<void> finish(const AlignmentReport& report);

 private:
  struct State;
  explicit TakeWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// What of a take is read, by the names of streams and arrays; of an empty list all.
struct TakeParts {
  std::vector<std::string> streams, arrays;
};

/// Reads a take that TakeWriter wrote, in order of rows or any window of them. Nothing in the file
/// is trusted: types, shapes and places are held against each other and against the file's length
/// before anything is allocated, numbers are finite, stamps rise. HDF5 itself can crash on a
/// hostile file: open what is not known to be ours in a child process (guarded.h).
class TakeReader {
 public:
  /// Of other `parts` nothing is looked at: other streams stand in no header, other arrays are
  /// empty in a slab.
  static Result<TakeReader> open(FileSystem& files, std::string path, const TakeParts& parts = {});
  TakeReader(TakeReader&& other) noexcept;
  TakeReader& operator=(TakeReader&& other) noexcept;
  TakeReader(const TakeReader&) = delete;
  TakeReader& operator=(const TakeReader&) = delete;
  ~TakeReader();

  const TakeHeader& header() const;
  /// The version of kinalign that wrote it: "kinalign 0.1.0".
  const std::string& software() const;
  /// Fills the next slab, of at most 4096 rows or 16 MiB; false at the end.
  Result<bool> next(TakeSlab& slab);
  /// Fills `slab` with these rows, wherever next() is.
  Result<void> read(std::uint64_t first, std::uint64_t count, TakeSlab& slab);
  /// All stamps.
  Result<std::vector<Time>> stamps();
  /// The report as it stands in the file, schema kinalign.report/1 (report_json.h).
  Result<std::string> report_json() const;

 private:
  struct State;
  explicit TakeReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// A whole take in memory, without its report: for tests and small jobs.
Result<Take> read_take(FileSystem& files, const std::string& path);

}  // namespace kinalign
