// SPDX-License-Identifier: Apache-2.0
// Decodes the stream of `kinalign record --live-port` while it arrives: samples of nodes, frames of
// a Kinect, and marks. Stamps are on the axis of the recording's log times (UTC). A stamp never
// waits for later messages. It comes from the live clock or, if that clock is not known yet, from
// the arrival.
#pragma once

#include "kinalign/clock/live/live_clock.h"
#include "kinalign/mcap/reader.h"
#include "kinalign/motion/streams.h"
#include "kinalign/protocols/kinect/message.h"
#include "kinalign/recording/format.h"
#include "kinalign/wire/node_sample.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// One sample of a node, with its stamp and the arrival of its datagram.
struct LiveNodeSample {
  const RawChannel* node = nullptr;  // valid as long as the LiveStream exists
  Time stamp{}, arrival{};
  NodeSample sample;  // all values are finite, and no orientation is zero
};

/// One row of joints (kinect_joints) of the person that kinalign follows.
struct LiveKinectRow {
  const RawChannel* kinect = nullptr;
  Time arrival{};
  PointFrames row;  // one row, with its stamp
};

/// A mark and its arrival, on the same time axis as all stamps.
struct LiveMark {
  RecordedMark mark;
  Time at{};
};

/// The content of one piece of the stream. Each kind is in the order of arrival.
struct LiveData {
  std::vector<LiveNodeSample> samples;
  std::vector<LiveKinectRow> rows;
  std::vector<LiveMark> marks;
};

/// Counts since the beginning of the stream.
struct LiveStreamCounts {
  std::uint64_t messages = 0;
  std::uint64_t lost = 0;     // missing messages, because the reading program was too slow
  std::uint64_t refused = 0;  // samples and frames with an implausible stamp or value
};

/// One connection to the recorder. Devices are created when their channels are defined, and exist
/// as long as this object. The pointers in LiveData therefore stay valid. The memory is limited by
/// the size of a record, the number of channels, and the limits of the clocks.
class LiveStream {
 public:
  // The limit on a record, bytes.
  static constexpr std::uint64_t most_record = std::uint64_t{1} << 20;
  static constexpr std::size_t most_channels = 1024;
  /// The recorder sends a message every second. If arrivals have a longer gap, the stream is not
  /// from the recorder.
  static constexpr Duration longest_silence = std::chrono::seconds(60);

  LiveStream();
  LiveStream(const LiveStream&) = delete;
  LiveStream& operator=(const LiveStream&) = delete;
  ~LiveStream();

  /// Takes the next bytes and appends their content to `news`. Fails if they are not a stream of
  /// kinalign record. After a failure the object must not be used again.
  Result<void> take(std::string_view bytes, LiveData& news);

  /// Call this when the stream has ended.
  void end();
  /// True if kinalign record ended the stream properly.
  bool closed() const { return reader_.closed(); }
  /// The arrival of the newest message; empty before the first message.
  std::optional<Time> now() const { return now_; }
  /// The facts of the recording; empty until they have arrived.
  const std::optional<RecordingFacts>& facts() const { return facts_; }
  const LiveStreamCounts& counts() const { return counts_; }

 private:
  struct Channel;
  struct NodeDevice;
  struct KinectDevice;

  Result<void> take_record(const McapRecord& record, LiveData& news);
  Result<void> define(const McapChannel& channel);
  Result<void> take_message(const McapMessage& message, LiveData& news);
  void take_node(NodeDevice& device, const RecordedMessage& message, LiveData& news);
  void take_kinect(KinectDevice& device, const RecordedMessage& message, LiveData& news);
  void take_frame(KinectDevice& device, const KinectFrame& frame, const RecordedMessage& message,
                  LiveData& news);
  Time on_axis(HostTime host) const {
    return Time{host.time_since_epoch() + facts_->utc_minus_host()};
  }

  McapReader reader_{most_record};
  std::optional<RecordingFacts> facts_;
  std::optional<Time> now_;
  std::map<std::uint16_t, Channel> channels_;
  std::map<std::string, std::unique_ptr<NodeDevice>> nodes_;      // by stream and node id
  std::map<std::string, std::unique_ptr<KinectDevice>> kinects_;  // by stream
  LiveStreamCounts counts_;
};

}  // namespace kinalign
