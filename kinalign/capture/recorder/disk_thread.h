// SPDX-License-Identifier: Apache-2.0
// A RecordingDisk behind two threads: one begins the file, packs and writes, one syncs, so that who
// receives never waits, and a kill during a slow sync costs no more than at any other time.
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

struct DiskStatus {
  std::vector<std::string> paths;           // the recording's files; none: not begun yet
  std::uint64_t bytes = 0;                  // in them
  std::uint64_t waiting_bytes = 0;          // that only memory has
  std::optional<std::uint64_t> free_bytes;  // that the disk still takes; absent: it does not say
  std::uint64_t dropped = 0;     // messages: memory was full, or they were given up at the end
  std::optional<Error> refused;  // by the disk just now; tried again with what comes next
  bool finished = false;         // nothing more is written; `refused`: not all could be, and
                                 // without a path nothing at all
};

class DiskThread {
 public:
  /// Bytes that wait for the disk at most: 19 minutes of the paper's devices.
  static constexpr std::uint64_t most_waiting = std::uint64_t{256} << 20;

  /// Asked on the writing thread, each second until it succeeds or nobody wants it any more: what
  /// is pushed meanwhile waits.
  using Open = std::function<Result<RecordingDisk>()>;
  DiskThread(Open open, McapCompression compression);
  /// As finish() and give_up(), and waits.
  ~DiskThread();
  DiskThread(const DiskThread&) = delete;
  DiskThread& operator=(const DiskThread&) = delete;

  /// The disk's work begins; until then what is pushed waits. Fails where the system has no thread
  /// to give, and may be asked again.
  Result<void> start();

  /// Waits for nothing. `room`: bytes that may wait; where that has no room, it is dropped.
  void push(McapChunkContent chunk, std::uint64_t room = most_waiting);
  /// No more will be pushed. Returns at once: status().finished says when all is done. What the
  /// disk refuses is tried again each second: somebody may make room.
  void finish();
  /// After finish(): tries once more. What the disk then refuses counts as dropped.
  void give_up();

  DiskStatus status() const;
  /// Since this was asked last.
  std::vector<PartFailure> take_failures();

 private:
  void write();
  bool begin();
  void drop_all();
  void sync();
  void look_at_room(std::unique_lock<std::mutex>& lock);
  void work_on(std::unique_lock<std::mutex>& lock);
  void work_on_end(std::unique_lock<std::mutex>& lock);
  void publish(const Result<void>& result);

  Open open_;
  std::optional<RecordingDisk> disk_;  // both the writing thread's
  McapCompression compression_;

  mutable std::mutex mutex_;  // of all below
  std::condition_variable written_, asked_;
  std::deque<McapChunkContent> queue_;
  std::uint64_t queue_bytes_ = 0;
  std::optional<RecordingDisk::Sync> due_;  // for the syncing thread
  std::optional<Result<void>> synced_;      // and its answer
  bool syncing_ = false, finishing_ = false, giving_up_ = false, done_ = false;
  DiskStatus status_;
  std::vector<PartFailure> failures_;

  std::thread writer_, syncer_;  // last: they use all above
};

}  // namespace kinalign
