// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/session_take.h"

namespace kinalign {

namespace {

constexpr int most_tries = 100;  // a disk may make names and no files

/// Begins a take's file, on the disk's thread: it owns all that it needs for it.
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
      path = next;  // another recorder has taken the name meanwhile
    }
  }
  Result<RecordingDisk> open(const std::string& path) {
    head.facts.first = std::string(file_name(path));
    const auto of_part = [head = head](int part) mutable -> RecordingHead {
      head.facts.part = part;
      return {{std::string(recording_profile), "kinalign " KINALIGN_VERSION},
              {to_metadata(head.facts), to_metadata(head.expected)},
              head.attachments};
    };
    return RecordingDisk::open(*files, path, of_part);
  }
};

}  // namespace

std::shared_ptr<SessionTake> begin_take(FileSystem& files, const TakePlan& plan, TakeHead head,
                                        McapCompression compression,
                                        const std::shared_ptr<SessionTake>& before) {
  head.facts.subject = plan.subject;
  head.facts.action = plan.action;
  std::shared_ptr<const DiskThread> behind;
  if (before) behind = {before, &before->disk};
  return std::shared_ptr<SessionTake>(new SessionTake{
      {},
      std::nullopt,
      {TakeFiles{&files, plan.free_path, std::move(head)}, compression, std::move(behind)}});
}

}  // namespace kinalign
