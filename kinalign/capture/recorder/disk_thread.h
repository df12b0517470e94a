// SPDX-License-Identifier: Apache-2.0
// A RecordingDisk with two threads. One opens the file, compresses and writes; the other syncs. So
// the receiving thread never waits for the disk, and a kill during a slow sync loses no more data
// than at any other time.
#pragma once

#include "kinalign/capture/recorder/recording_disk.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace kinalign {

/// A copy of what the writing thread published last, with the queue's bytes added.
struct DiskStatus {
  std::vector<std::string> paths;           // the recording's files; empty: no file is open yet
  std::uint64_t bytes = 0;                  // in these files
  std::uint64_t waiting_bytes = 0;          // not yet safely on the disk
  std::optional<std::uint64_t> free_bytes;  // free space of the disk; absent: unknown
  std::uint64_t dropped = 0;     // messages lost because memory was full or because of give_up()
  std::optional<Error> refused;  // the present error of the disk; the write is tried again
  // True if no more is written. If `refused` is set, some data could not be written; if `paths` is
  // also empty, none was.
  bool finished = false;
};

/// Three threads use it. The caller's thread only queues chunks and reads the status. The writing
/// thread owns the disk. The syncing thread gets the file for each sync through `due_`.
class DiskThread {
 public:
  /// Limit on the bytes that wait for the disk: 19 minutes of the paper's devices.
  static constexpr std::uint64_t most_waiting = std::uint64_t{256} << 20;

  /// Opens the file. It is called on the writing thread, every second until it succeeds or
  /// give_up() is called. Chunks pushed before that wait.
  using Open = std::function<Result<RecordingDisk>()>;
  DiskThread(Open open, McapCompression compression);
  /// Calls finish() and give_up(), and waits for the threads.
  ~DiskThread();
  DiskThread(const DiskThread&) = delete;
  DiskThread& operator=(const DiskThread&) = delete;

  /// Starts the threads unless they run already. Chunks pushed before that wait. Fails if the
  /// system has no thread available; it may then be called again.
  Result<void> start();

  /// Queues a chunk without blocking. `room`: limit on the waiting bytes. A chunk that exceeds it
  /// is dropped.
  void push(McapChunkContent chunk, std::uint64_t room = most_waiting);
  /// Call after the last push. Returns at once; status().finished says when all is written. If the
  /// disk refuses a write, it is tried again every second, because somebody may free space.
  void finish();
  /// Call after finish(). Tries once more; messages that the disk then refuses count as dropped.
  void give_up();

  DiskStatus status() const;
  /// Failures since the previous call.
  std::vector<PartFailure> take_failures();

 private:
  /// `write` and `sync` are the bodies of the two threads; the others are steps of them.
  void write();
  bool begin();
  void drop_all();
  void sync();
  void look_at_room(std::unique_lock<std::mutex>& lock);
  void work_on(std::unique_lock<std::mutex>& lock);
  void work_on_end(std::unique_lock<std::mutex>& lock);
  void publish(const Result<void>& result);

  Open open_;
  std::optional<RecordingDisk> disk_;  // used, like open_, only by the writing thread
  McapCompression compression_;

  mutable std::mutex mutex_;  // guards all members below
  std::condition_variable written_, asked_;
  std::deque<McapChunkContent> queue_;
  std::uint64_t queue_bytes_ = 0;
  /// One sync at a time: the writing thread sets `due_`, the syncing thread sets `synced_`, and the
  /// writing thread takes both.
  std::optional<RecordingDisk::Sync> due_;  // the next sync, for the syncing thread
  std::optional<Result<void>> synced_;      // the result of the sync
  bool syncing_ = false, finishing_ = false, giving_up_ = false, done_ = false;
  DiskStatus status_;
  std::vector<PartFailure> failures_;

  std::thread writer_, syncer_;  // declared last, since they use all members above
};

}  // namespace kinalign
