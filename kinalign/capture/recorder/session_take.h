// SPDX-License-Identifier: Apache-2.0
// A take of a recording session: its file and its result.
#pragma once

#include "kinalign/capture/nodes/node_status.h"
#include "kinalign/capture/recorder/disk_thread.h"
#include "kinalign/capture/recorder/stream_status.h"
#include "kinalign/recording/format.h"
#include "kinalign/wire/time.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// A mark and its arrival.
using ReceivedMark = std::pair<RecordedMark, HostTime>;

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

/// The session keeps it until release_take(), and the recorder while the take is in progress. Its
/// destructor waits for the disk's threads.
struct SessionTake {
  HostTime begun{};
  std::optional<TakeEnd> end;  // absent: the take is in progress
  bool disk_started = false;
  DiskThread disk;
};

/// The MCAP header of each file of a take, and of each live stream.
McapHeader recording_header();

/// The records at the beginning of each file of a take.
/// It is copied for each file, because each file must be readable alone.
struct TakeHead {
  RecordingFacts facts;
  ExpectedDevices expected;
  std::vector<McapAttachment> attachments;
};

/// Makes a take. Its disk is not started yet.
std::shared_ptr<SessionTake> begin_take(FileSystem& files, const TakePlan& plan, TakeHead head,
                                        McapCompression compression);

}  // namespace kinalign
