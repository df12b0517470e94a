// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/session_take.h"

#include <utility>

namespace kinalign {

namespace {

constexpr int most_tries = 100;  // a disk may accept names but no files

/// Opens a take's file on the disk's thread. It owns all data that it needs.
struct TakeFiles {
  FileSystem* files;
  std::function<std::string()> free_path;
  TakeHead head;

  // If the same path is still free, the failure has another cause than a taken name.
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
      {}, std::nullopt, false, {TakeFiles{&files, plan.free_path, std::move(head)}, compression}});
}

}  // namespace kinalign
