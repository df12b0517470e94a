// SPDX-License-Identifier: Apache-2.0
// A take of a recording session: where it goes, and how it ended. Several may stand side by side:
// one records while the disk still writes the end of the one before.
#pragma once

#include "kinalign/capture/nodes/node_status.h"
#include "kinalign/capture/recorder/disk_thread.h"
#include "kinalign/capture/recorder/stream_status.h"
#include "kinalign/recording/format.h"
#include "kinalign/wire/time.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// A mark and when it came.
using HeardMark = std::pair<RecordedMark, HostTime>;

struct TakePlan {
  /// A path that ends in .mcap, under which there is no file yet. Asked for on the disk's thread,
  /// however long that takes, and again where another recorder took the name meanwhile.
  std::function<std::string()> free_path;
  std::string subject{}, action{};
};

/// What had come in a take when it ended.
struct TakeEnd {
  HostTime at{};
  std::vector<StreamStatus> streams;
  std::vector<std::pair<std::string, PortCounts>> ports;  // by the device's name
  std::vector<NodeStatus> nodes;
};

struct SessionTake {
  HostTime begun{};
  std::optional<TakeEnd> end;  // absent: it goes on
  DiskThread disk;
};

/// Of each file of a take, and of each live stream.
McapHeader recording_header();

/// What stands in front of each file of a take.
struct TakeHead {
  RecordingFacts facts;
  ExpectedDevices expected;
  std::vector<McapAttachment> attachments;
};

/// Its disk is not started yet.
std::shared_ptr<SessionTake> begin_take(FileSystem& files, const TakePlan& plan, TakeHead head,
                                        McapCompression compression);

/// A session's takes until the disk has all of them. Files are begun in the order of the takes, so
/// that they are numbered so, and a few are written at a time: however many marks somebody sends,
/// they make no more threads.
class TakeQueue {
 public:
  static constexpr std::size_t most = 32;
  static constexpr std::size_t most_writing = 8;  // at once: each has two threads

  void add(std::shared_ptr<SessionTake> take);
  /// Those that were added, in their order, each once; nullptr: none more.
  std::shared_ptr<SessionTake> next();
  /// Starts the disks that may; to be called again and again.
  void run();
  /// As many wait as may, for the disk or to be asked for.
  bool is_full() const { return std::max(queued_.size() + writing_.size(), added_.size()) >= most; }
  /// Bytes of all that only memory has.
  std::uint64_t waiting_bytes() const { return waiting_beside(nullptr); }
  /// Bytes that may wait of `take`, beside those of the others.
  std::uint64_t room(const SessionTake& take) const;

 private:
  bool next_may() const;
  std::uint64_t waiting_beside(const SessionTake* one) const;

  std::deque<std::shared_ptr<SessionTake>> added_;   // since next() was asked
  std::deque<std::shared_ptr<SessionTake>> queued_;  // whose disks are not started
  std::vector<std::shared_ptr<SessionTake>> writing_;
};

}  // namespace kinalign
