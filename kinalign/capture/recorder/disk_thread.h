// SPDX-License-Identifier: Apache-2.0
// Writes a recording with two threads. One thread opens the file, compresses and writes; the other
// thread syncs the file. The receiving thread therefore never waits for the disk. Writing goes on
// during a slow sync, so a killed program loses no more data then than at other times.
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

/// The status that the writing thread published last. `waiting_bytes` also includes the queue.
struct DiskStatus {
  std::vector<std::string> paths;           // the recording's files; empty: no file is open yet
  std::uint64_t bytes = 0;                  // size of these files
  std::uint64_t waiting_bytes = 0;          // bytes that are not yet safely on the disk
  std::optional<std::uint64_t> free_bytes;  // free space of the disk; absent: unknown
  std::uint64_t dropped = 0;     // messages lost because memory was full or because of give_up()
  std::optional<Error> refused;  // the present error of the disk; the write is repeated
  // No more is written. If `refused` is set, some data could not be written. If `paths` is empty
  // too, no data was written.
  bool finished = false;
};

/// Three threads use this object. The caller's thread only queues chunks and reads the status. The
/// writing thread owns the disk. The syncing thread gets the file for each sync through `due_`.
class DiskThread {
 public:
  /// Limit on the bytes that wait for the disk: 19 minutes of data from a motion capture suit, a
  /// Kinect and five nodes.
  static constexpr std::uint64_t most_waiting = std::uint64_t{256} << 20;

  /// Opens the file. Called on the writing thread, every second until it succeeds or give_up() is
  /// called. Chunks that were pushed before wait in memory.
  using Open = std::function<Result<RecordingDisk>()>;
  DiskThread(Open open, McapCompression compression);
  /// Calls finish() and give_up(), and waits for the threads.
  ~DiskThread();
  DiskThread(const DiskThread&) = delete;
  DiskThread& operator=(const DiskThread&) = delete;

  /// Starts the threads if they do not run yet. Fails if the system has no thread available;
  /// start() may then be called again. Chunks that were pushed before wait in memory.
  Result<void> start();

  /// Queues a chunk without blocking. `room`: limit on the waiting bytes. If the chunk would exceed
  /// the limit, it is dropped.
  void push(McapChunkContent chunk, std::uint64_t room = most_waiting);
  /// Call after the last push. Returns at once; status().finished tells when everything is written.
  /// If the disk refuses a write, the write is repeated every second, because the user may free
  /// space.
  void finish();
  /// Call after finish(). Writes once more. Messages that the disk then refuses count as dropped.
  void give_up();

  DiskStatus status() const;
  /// Failures since the previous call of this function.
  std::vector<PartFailure> take_failures();

 private:
  /// `write` and `sync` are the bodies of the two threads. The other functions are steps of `write`
  /// and `sync`.
  void write();
  bool begin();
  void drop_all();
  void sync();
  void look_at_room(std::unique_lock<std::mutex>& lock);
  void work_on(std::unique_lock<std::mutex>& lock);
  void work_on_end(std::unique_lock<std::mutex>& lock);
  void publish(const Result<void>& result);

  Open open_;
  std::optional<RecordingDisk> disk_;  // like open_, used only by the writing thread
  McapCompression compression_;

  mutable std::mutex mutex_;  // guards all members below
  std::condition_variable written_, asked_;
  std::deque<McapChunkContent> queue_;
  std::uint64_t queue_bytes_ = 0;
  /// Only one sync runs at a time. The writing thread sets `due_`, the syncing thread sets
  /// `synced_`, and the writing thread clears both.
  std::optional<RecordingDisk::Sync> due_;  // the next sync, for the syncing thread
  std::optional<Result<void>> synced_;      // the result of the sync
  bool syncing_ = false, finishing_ = false, giving_up_ = false, done_ = false;
  DiskStatus status_;
  std::vector<PartFailure> failures_;

  std::thread writer_, syncer_;  // declared last, because they use all members above
};

}  // namespace kinalign
