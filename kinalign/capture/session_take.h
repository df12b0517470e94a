// SPDX-License-Identifier: Apache-2.0
// A take of a recording session: where it goes, and how it ended. Several may stand side by side:
// one records while the disk still writes the end of the one before.
#pragma once

#include "kinalign/capture/disk_thread.h"
#include "kinalign/capture/node_receiver.h"
#include "kinalign/capture/recorded_source.h"
#include "kinalign/io/recording_counts.h"
#include "kinalign/io/recording_format.h"
#include "kinalign/wire/time.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

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

/// What stands in front of each file of a take.
struct TakeHead {
  RecordingFacts facts;
  ExpectedDevices expected;
  std::vector<McapAttachment> attachments;
};

/// Its file is begun as soon as that of `before` is, which may be nullptr: so that they are
/// numbered in their order.
std::shared_ptr<SessionTake> begin_take(FileSystem& files, const TakePlan& plan, TakeHead head,
                                        McapCompression compression,
                                        const std::shared_ptr<SessionTake>& before);

}  // namespace kinalign
