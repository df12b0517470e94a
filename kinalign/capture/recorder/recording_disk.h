// SPDX-License-Identifier: Apache-2.0
// A recording on its way to the disk. Where the disk refuses a write or a sync, the recording goes
// on in a new file, which begins with all that had not reached the disk for sure: after a failed
// sync the kernel may have dropped any of it (fsync(2), and Rebello et al., «Can Applications
// Recover from fsync Failures?», USENIX ATC 2020). Has no thread: disk_thread.h gives it two.
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

/// What each file of a recording begins with.
struct RecordingHead {
  McapHeader header;
  std::vector<McapMetadata> metadata;
  std::vector<McapAttachment> attachments;
};

/// A file was given up, and why; `next`: where the recording goes on, empty where nowhere yet: then
/// a second one says where, once it does.
struct PartFailure {
  Error why;
  std::string next;
};

class RecordingDisk {
 public:
  /// Makes PATH, and syncs nothing. `path` ends in .mcap; further files
  /// are PATH with .part2.mcap at its end, and so on. `head` is asked for the number of the part,
  /// from 1.
  using MakeHead = std::function<RecordingHead(int part)>;
  static Result<RecordingDisk> open(FileSystem& files, std::string path, MakeHead head);

  /// Fails where no file could be had for it any more: then it is kept, and tried again with the
  /// next one or with finish().
  Result<void> write(McapStoredChunk chunk);

  /// What a sync is to bring to the disk; absent: nothing is new. The file stays for the sync.
  struct Sync {
    std::shared_ptr<GrowingFile> file;
    std::uint64_t size = 0;
  };
  std::optional<Sync> unsynced() const;
  /// How the sync went. Fails as write() does.
  Result<void> synced(const Sync& sync, const Result<void>& result);

  /// `end`, index, sync. The files stay whatever happens.
  Result<void> finish(const McapMetadata& end);

  /// Since this was asked last.
  std::vector<PartFailure> take_failures() { return std::exchange(failures_, {}); }
  std::vector<std::string> paths() const;  // all files, in order
  std::uint64_t bytes() const;
  /// Bytes that only memory has for sure.
  std::uint64_t kept_bytes() const { return kept_bytes_; }
  /// Messages that no file ever took.
  std::uint64_t unwritten() const;

 private:
  RecordingDisk(FileSystem& files, std::string path, MakeHead head)
      : files_(&files), path_(std::move(path)), head_(std::move(head)) {}
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
  bool open_ = false;         // the file: chunks may be added to it
  bool stands_ = false;       // the newest of paths_: it has not been given up
  std::uint64_t synced_ = 0;  // bytes of it
  struct Kept {
    McapStoredChunk chunk;
    std::uint64_t end = 0;  // in the file; 0: it is not in it
    bool written = false;   // it is, or was in one before
  };
  std::deque<Kept> kept_;
  std::uint64_t kept_bytes_ = 0, bytes_before_ = 0;
  struct Repeated {
    std::string path;
    std::size_t chunks = 0;
    std::uint64_t bytes = 0;
  };
  std::optional<Repeated> repeated_;  // a file that goes once the next one has all of it
  bool end_told_ = false;             // that it failed
  std::optional<Error> given_up_;     // a file was, and the recording has not gone on yet
  std::vector<PartFailure> failures_;
};

}  // namespace kinalign
