// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/session_take.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace kinalign {

namespace {

constexpr int most_tries = 100;  // a disk may accept names but no files

/// Opens a take's file on the disk's thread. It owns all data that it needs.
struct TakeFiles {
  FileSystem* files;
  std::function<std::string()> free_path;
  TakeHead head;

  Result<RecordingDisk> operator()() {
    std::string path = free_path();
    for (int tries = 1;; ++tries) {
      Result<RecordingDisk> opened = open(path);
      const std::string next = opened ? path : free_path();
      if (next == path || tries == most_tries) return opened;
      path = next;  // another recorder has taken the name in the meantime
    }
  }
  Result<RecordingDisk> open(const std::string& path) {
    head.facts.first = std::string(file_name(path));
    const auto of_part = [head = head](int part) mutable -> RecordingHead {
      head.facts.part = part;
      return {recording_header(),
              {to_metadata(head.facts), to_metadata(head.expected)},
              head.attachments};
    };
    return RecordingDisk::open(*files, path, of_part);
  }
};

}  // namespace

McapHeader recording_header() {
  return {std::string(recording_profile), "kinalign " KINALIGN_VERSION};
}

std::shared_ptr<SessionTake> begin_take(FileSystem& files, const TakePlan& plan, TakeHead head,
                                        McapCompression compression) {
  head.facts.subject = plan.subject;
  head.facts.action = plan.action;
  return std::shared_ptr<SessionTake>(new SessionTake{
      {}, std::nullopt, {TakeFiles{&files, plan.free_path, std::move(head)}, compression}});
}

void TakeQueue::add(std::shared_ptr<SessionTake> take) {
  added_.push_back(take);
  queued_.push_back(std::move(take));
  run();
}

std::shared_ptr<SessionTake> TakeQueue::next() {
  if (added_.empty()) return nullptr;
  std::shared_ptr<SessionTake> next = std::move(added_.front());
  added_.pop_front();
  return next;
}

// A take whose disk gave up before it was started is skipped.
void TakeQueue::run() {
  std::erase_if(writing_, [](const auto& take) { return take->disk.status().finished; });
  while (!queued_.empty() && next_may()) {
    const std::shared_ptr<SessionTake>& next = queued_.front();
    const bool given_up = next->disk.status().finished;
    if (!given_up && !next->disk.start()) return;
    if (!given_up) writing_.push_back(next);
    queued_.pop_front();
  }
}

// The next disk starts only when the file of the one before is open, so that files are numbered in
// the order of takes.
bool TakeQueue::next_may() const {
  if (writing_.empty()) return true;
  return writing_.size() < most_writing && !writing_.back()->disk.status().paths.empty();
}

std::uint64_t TakeQueue::waiting_beside(const SessionTake* one) const {
  const auto add = [one](std::uint64_t sum, const std::shared_ptr<SessionTake>& take) {
    return take.get() == one ? sum : sum + take->disk.status().waiting_bytes;
  };
  const auto queued = std::accumulate(queued_.begin(), queued_.end(), std::uint64_t{0}, add);
  return std::accumulate(writing_.begin(), writing_.end(), queued, add);
}

std::uint64_t TakeQueue::room(const SessionTake& take) const {
  return DiskThread::most_waiting - std::min(waiting_beside(&take), DiskThread::most_waiting);
}

}  // namespace kinalign
