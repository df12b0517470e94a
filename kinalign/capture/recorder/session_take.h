// SPDX-License-Identifier: Apache-2.0
// A take of a recording session: its file and its result. Several takes may exist at once: one
// records while the disk still writes the end of the previous one.
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

/// A mark and its arrival.
using HeardMark = std::pair<RecordedMark, HostTime>;

struct TakePlan {
  /// Returns a path that ends in .mcap and does not exist yet. It is called on the disk's thread,
  /// where it may take long. It is called again if another recorder has taken the name.
  std::function<std::string()> free_path;
  std::string subject{}, action{};
};

/// The state of a take when it ended.
struct TakeEnd {
  HostTime at{};
  std::vector<StreamStatus> streams;
  std::vector<std::pair<std::string, PortCounts>> ports;  // by the device's name
  std::vector<NodeStatus> nodes;
};

struct SessionTake {
  HostTime begun{};
  std::optional<TakeEnd> end;  // absent: the take is in progress
  DiskThread disk;
};

/// The MCAP header of each file of a take, and of each live stream.
McapHeader recording_header();

/// The records at the beginning of each file of a take.
struct TakeHead {
  RecordingFacts facts;
  ExpectedDevices expected;
  std::vector<McapAttachment> attachments;
};

/// Makes a take. Its disk is not started yet.
std::shared_ptr<SessionTake> begin_take(FileSystem& files, const TakePlan& plan, TakeHead head,
                                        McapCompression compression);

/// The takes of a session that are not completely on the disk. Files are opened in the order of the
/// takes, so that their numbers have this order. Only a few are written at a time, so the number of
/// threads is limited, however many marks arrive.
class TakeQueue {
 public:
  static constexpr std::size_t most = 32;
  static constexpr std::size_t most_writing = 8;  // at once; each has two threads

  void add(std::shared_ptr<SessionTake> take);
  /// Added takes, in order, each once. nullptr: no more.
  std::shared_ptr<SessionTake> next();
  /// Starts the disks that may start. Call it repeatedly.
  void run();
  /// Returns whether the limit of takes that wait, for the disk or for next(), is reached.
  bool is_full() const { return std::max(queued_.size() + writing_.size(), added_.size()) >= most; }
  /// Bytes of all takes that are not yet safely on the disk.
  std::uint64_t waiting_bytes() const { return waiting_beside(nullptr); }
  /// Bytes of `take` that may wait for the disk, considering the other takes.
  std::uint64_t room(const SessionTake& take) const;

 private:
  bool next_may() const;
  std::uint64_t waiting_beside(const SessionTake* one) const;

  std::deque<std::shared_ptr<SessionTake>> added_;   // not yet returned by next()
  std::deque<std::shared_ptr<SessionTake>> queued_;  // their disks are not started
  std::vector<std::shared_ptr<SessionTake>> writing_;
};

}  // namespace kinalign
