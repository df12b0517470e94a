// SPDX-License-Identifier: Apache-2.0
// Decodes the stream of `kinalign record --live-port` as it arrives: samples of nodes, frames of a
// Kinect, and marks. Stamps are on the axis of the recording's log times (UTC). They need no later
// message: they come from the live clock or, until that is known, from the arrival.
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

/// One sample of a node, stamped, with the arrival of its datagram.
struct LiveNodeSample {
  const RawChannel* node = nullptr;  // valid as long as the stream object
  Time stamp{}, arrival{};
  NodeSample sample;  // all values are finite, and an orientation is not zero
};

/// One row of joints (kinect_joints) of the followed person.
struct LiveKinectRow {
  const RawChannel* kinect = nullptr;
  Time arrival{};
  PointFrames row;  // one row, with its stamp
};

/// A mark and its arrival, on the same axis as all stamps.
struct LiveMark {
  RecordedMark mark;
  Time at{};
};

/// The content of a piece of the stream, each kind in the order of arrival.
struct LiveData {
  std::vector<LiveNodeSample> samples;
  std::vector<LiveKinectRow> rows;
  std::vector<LiveMark> marks;
};

/// Counts since the beginning of the stream.
struct LiveStreamCounts {
  std::uint64_t messages = 0;
  std::uint64_t lost = 0;     // missing in the stream, because this program read too slowly
  std::uint64_t refused = 0;  // samples and frames with an implausible stamp or impossible values
};

/// One connection to the recorder. Devices are created when their channels are defined and live as
/// long as the object, so the pointers in LiveData stay valid. Memory is limited: by the size of a
/// record, the number of channels, and the clocks' own limits.
class LiveStream {
 public:
  // Bytes of one record.
  static constexpr std::uint64_t most_record = std::uint64_t{1} << 20;
  static constexpr std::size_t most_channels = 1024;
  /// The recorder sends a message every second. A longer gap between arrivals means that the stream
  /// does not come from the recorder.
  static constexpr Duration longest_silence = std::chrono::seconds(60);

  LiveStream();
  LiveStream(const LiveStream&) = delete;
  LiveStream& operator=(const LiveStream&) = delete;
  ~LiveStream();

  /// Takes the next bytes and appends their content to `news`. Fails if they are not a stream of
  /// kinalign record; the object must not be used again then.
  Result<void> take(std::string_view bytes, LiveData& news);

  /// Call when no more bytes come.
  void end();
  /// Returns whether the stream was ended properly by record.
  bool closed() const { return reader_.closed(); }
  /// Arrival of the newest message; absent before the first one.
  std::optional<Time> now() const { return now_; }
  /// The facts of the recording. Absent before the beginning was read.
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
