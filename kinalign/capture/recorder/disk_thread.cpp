// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/disk_thread.h"

#include "kinalign/recording/format.h"

#include <sys/statvfs.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

namespace kinalign {

namespace {

// Free space for this user. f_bavail excludes the space reserved for root.
std::optional<std::uint64_t> free_bytes(const std::string& path) {
  struct statvfs status {};
  const std::string in = folder(path).empty() ? "." : std::string(folder(path));
  if (::statvfs(in.c_str(), &status) != 0) return std::nullopt;
  return std::uint64_t{status.f_bavail} * status.f_frsize;
}

std::uint64_t messages_in(const McapChunkContent& chunk) {
  std::uint64_t count = 0;
  for (const auto& [channel, entries] : chunk.messages()) count += entries.size();
  return count;
}

}  // namespace

DiskThread::DiskThread(Open open, McapCompression compression)
    : open_(std::move(open)), compression_(compression) {}

DiskThread::~DiskThread() {
  finish();
  give_up();
  if (writer_.joinable()) writer_.join();
  if (syncer_.joinable()) syncer_.join();
}

// The standard library throws if the system has no thread. The exception is caught here.
Result<void> DiskThread::start() {
  if (writer_.joinable()) return {};
  try {
    syncer_ = std::thread([this] { sync(); });
    writer_ = std::thread([this] { write(); });
    return {};
  } catch (const std::system_error& fault) {
    Error why{"", 0, "a thread for the disk", fault.code().message()};
    {
      const std::lock_guard lock(mutex_);
      done_ = true;  // ends syncer_ if only syncer_ started
    }
    asked_.notify_one();
    if (syncer_.joinable()) syncer_.join();
    const std::lock_guard lock(mutex_);
    done_ = false;
    status_.refused = why;
    return Failure(std::move(why));
  }
}

void DiskThread::push(McapChunkContent chunk, std::uint64_t room) {
  {
    const std::lock_guard lock(mutex_);
    // The limit applies to two kinds of chunks: those in the queue, and those that the disk keeps
    // until a sync has confirmed them.
    if (status_.waiting_bytes + queue_bytes_ + chunk.size() > room) {
      status_.dropped += messages_in(chunk);
      return;
    }
    queue_bytes_ += chunk.size();
    queue_.push_back(std::move(chunk));
  }
  written_.notify_one();
}

void DiskThread::finish() {
  {
    const std::lock_guard lock(mutex_);
    finishing_ = true;
  }
  written_.notify_one();
}

// If no writing thread runs, this function drops the chunks itself.
void DiskThread::give_up() {
  {
    const std::lock_guard lock(mutex_);
    giving_up_ = true;
    if (!writer_.joinable()) drop_all();
  }
  written_.notify_one();
}

DiskStatus DiskThread::status() const {
  const std::lock_guard lock(mutex_);
  DiskStatus status = status_;
  status.waiting_bytes += queue_bytes_;
  return status;
}

std::vector<PartFailure> DiskThread::take_failures() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failures_, {});
}

/// Updates the status after each step on the disk. The caller must hold the lock.
void DiskThread::publish(const Result<void>& result) {
  status_.paths = disk_->paths();
  status_.bytes = disk_->bytes();
  status_.waiting_bytes = disk_->kept_bytes();
  status_.refused = result ? std::nullopt : std::optional(result.error());
  for (PartFailure& failure : disk_->take_failures()) failures_.push_back(std::move(failure));
}

/// Drops all queued chunks, because there is no file for them.
void DiskThread::drop_all() {
  for (const McapChunkContent& chunk : queue_) status_.dropped += messages_in(chunk);
  queue_.clear();
  queue_bytes_ = 0;
  done_ = status_.finished = true;
}

/// Opens the file. Retries every second until give_up(). Returns whether a file is open.
bool DiskThread::begin() {
  while (!disk_ && !done_) {
    Result<RecordingDisk> opened = open_();
    std::unique_lock lock(mutex_);
    if (opened) {
      disk_ = *std::move(opened);
      publish({});
      due_ = disk_->unsynced();  // syncs the file's name and its head
      continue;
    }
    status_.refused = opened.error();
    if (giving_up_) {
      drop_all();
    } else {
      written_.wait_for(lock, std::chrono::seconds(1), [this] { return giving_up_; });
    }
  }
  // Releases the data that the function owns.
  open_ = nullptr;
  asked_.notify_one();
  return disk_.has_value();
}

void DiskThread::write() {
  if (!begin()) return;
  std::unique_lock lock(mutex_);
  while (!done_) {
    // The end wakes this thread too, so that the file is finished although no chunk arrives.
    written_.wait(lock, [this] { return !queue_.empty() || synced_ || finishing_; });
    work_on(lock);
    if (!done_ && !syncing_) due_ = disk_->unsynced();
    if (due_) asked_.notify_one();
  }
  asked_.notify_one();
}

/// Does one step of work. The lock is released during the step. The result of a sync is handled
/// first, because it may say that the file is damaged.
void DiskThread::work_on(std::unique_lock<std::mutex>& lock) {
  Result<void> result;
  std::uint64_t taken = 0;  // bytes taken from the queue
  if (synced_) {
    const Result<void> answer = *std::exchange(synced_, std::nullopt);
    const RecordingDisk::Sync sync = *std::exchange(due_, std::nullopt);
    syncing_ = false;
    lock.unlock();
    result = disk_->synced(sync, answer);
  } else if (!queue_.empty()) {
    const McapChunkContent chunk = std::move(queue_.front());
    queue_.pop_front();
    taken = chunk.size();
    lock.unlock();
    result = disk_->write(store(chunk, compression_));
  } else if (!syncing_) {
    return work_on_end(lock);
  } else {
    written_.wait(lock, [this] { return synced_.has_value(); });
    return;
  }
  lock.lock();
  // Subtracted only now, because a chunk counts as queued until the disk has it.
  queue_bytes_ -= taken;
  publish(result);
}

/// Finishes the file. `finished` and the result are published together.
void DiskThread::work_on_end(std::unique_lock<std::mutex>& lock) {
  due_.reset();  // finish() includes a sync
  const bool last = giving_up_;
  const McapMetadata end = to_metadata(RecordingEnd{status_.dropped});
  lock.unlock();
  const Result<void> result = disk_->finish(end);
  lock.lock();
  publish(result);
  // After the last attempt the recording is finished, with or without success.
  done_ = status_.finished = result || last;
  if (!result && last) status_.dropped += disk_->unwritten();
  if (!done_) written_.wait_for(lock, std::chrono::seconds(1), [this] { return giving_up_; });
}

/// Updates the free space of the disk. The syncing thread does this, because the call blocks if a
/// network disk is unreachable. The call is omitted at the end, because the program then waits for
/// this thread.
void DiskThread::look_at_room(std::unique_lock<std::mutex>& lock) {
  if (status_.paths.empty() || finishing_) return;
  const std::string path = status_.paths.back();
  lock.unlock();
  const auto free = free_bytes(path);
  lock.lock();
  status_.free_bytes = free;
}

/// Syncs the file repeatedly. Each failed sync begins a new file, so the pause after a failure
/// doubles each time.
void DiskThread::sync() {
  using Clock = std::chrono::steady_clock;
  constexpr Clock::duration shortest = std::chrono::seconds(1), longest = std::chrono::seconds(32);
  Clock::duration pause = shortest;
  Clock::time_point next{};
  const auto may_sync = [&] { return due_ && !syncing_ && Clock::now() >= next; };
  std::unique_lock lock(mutex_);
  while (!done_) {
    look_at_room(lock);
    asked_.wait_for(lock, shortest, [&] { return may_sync() || done_; });
    if (done_ || !may_sync()) continue;
    syncing_ = true;
    const RecordingDisk::Sync sync = *due_;
    lock.unlock();
    const Result<void> answer = sync.file->sync();
    lock.lock();
    synced_ = answer;
    written_.notify_one();
    if (!answer) next = Clock::now() + pause;
    pause = answer ? shortest : std::min(2 * pause, longest);
  }
}

}  // namespace kinalign
