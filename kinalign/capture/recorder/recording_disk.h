// SPDX-License-Identifier: Apache-2.0
// Writes a recording to the disk. If the disk refuses a write or a sync, the recording continues in
// a new file. The new file begins with all data that may not be on the disk. After a failed sync
// the kernel may have dropped any of that data (fsync(2), and Rebello et al., «Can Applications
// Recover from fsync Failures?», USENIX ATC 2020). The class has no thread; disk_thread.h adds two
// threads.
#pragma once

#include "kinalign/core/growing_file.h"
#include "kinalign/mcap/writer.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The records at the beginning of each file.
struct RecordingHead {
  McapHeader header;
  std::vector<McapMetadata> metadata;
  std::vector<McapAttachment> attachments;
};

/// A file was abandoned. `why`: the reason. `next`: the file in which the recording continues. If
/// `next` is empty, no such file exists yet; a second PartFailure names it later.
struct PartFailure {
  Error why;
  std::string next;
};

/// Invariant: a chunk stays in `kept_` until a sync of the present file has confirmed it. If a file
/// is abandoned, everything that it may lack is therefore still in memory.
class RecordingDisk {
 public:
  /// Creates the file `path`, which ends in .mcap, without a sync. Further files end in
  /// .part2.mcap, .part3.mcap and so on. `head` is called with the number of the part, from 1.
  using MakeHead = std::function<RecordingHead(int part)>;
  static Result<RecordingDisk> open(FileSystem& files, std::string path, MakeHead head);

  /// Writes a chunk. Fails if no file accepts the chunk. It is then kept and written with the next
  /// chunk or with finish().
  Result<void> write(McapStoredChunk chunk);

  /// The next sync: the file and its size. Absent if everything is synced. The file stays open
  /// during the sync.
  struct Sync {
    std::shared_ptr<GrowingFile> file;
    std::uint64_t size = 0;
  };
  std::optional<Sync> unsynced() const;
  /// Takes the result of a sync. Fails like write().
  Result<void> synced(const Sync& sync, const Result<void>& result);

  /// Writes `end` and the index, and syncs the file. The files remain even if this fails.
  Result<void> finish(const McapMetadata& end);

  /// Failures since the previous call of this function.
  std::vector<PartFailure> take_failures() { return std::exchange(failures_, {}); }
  std::vector<std::string> paths() const;  // all files, in the order of writing
  std::uint64_t bytes() const;
  /// Number of bytes that may not be on the disk yet.
  std::uint64_t kept_bytes() const { return kept_bytes_; }
  /// Number of messages that no file has accepted.
  std::uint64_t unwritten() const;

 private:
  RecordingDisk(FileSystem& files, std::string path, MakeHead head)
      : files_(&files), path_(std::move(path)), head_(std::move(head)) {}
  /// A file is open until it is finished or abandoned. `put_kept` opens a file if none is open and
  /// writes all chunks that it lacks. `next_part` abandons the present file first.
  Result<void> open_part();
  Result<void> put_kept();
  Result<void> next_part(const Error& why);
  void give_up_part();
  void remove_part();
  Result<void> finish_part();
  Result<void> finish_once(const McapMetadata& end);
  void forget_synced(std::uint64_t size);

  FileSystem* files_;
  std::string path_;
  MakeHead head_;
  std::vector<std::string> paths_;
  std::shared_ptr<GrowingFile> file_;
  std::unique_ptr<McapWriter> writer_;
  bool open_ = false;         // the file accepts chunks
  bool stands_ = false;       // the newest file of paths_ is not abandoned
  std::uint64_t synced_ = 0;  // bytes of the file that a sync has confirmed
  /// Chunks in the order of writing. Chunks with an `end` come first.
  struct Kept {
    McapStoredChunk chunk;
    std::uint64_t end = 0;  // end of the chunk in the present file; 0: not in it
    bool written = false;   // the chunk is, or was, in some file
  };
  std::deque<Kept> kept_;
  // bytes_before_: size of all earlier files
  std::uint64_t kept_bytes_ = 0, bytes_before_ = 0;
  // An abandoned file that no sync has confirmed. It is removed when another file has all its
  // chunks.
  struct Repeated {
    std::string path;
    std::size_t chunks = 0;
    std::uint64_t bytes = 0;
  };
  std::optional<Repeated> repeated_;  // removed as soon as the next file has all its chunks
  bool end_reported_ = false;         // the failure of finish() was reported
  // the reason for abandoning a file; absent once the recording continues
  std::optional<Error> given_up_;
  std::vector<PartFailure> failures_;
};

}  // namespace kinalign
