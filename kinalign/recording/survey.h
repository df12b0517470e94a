// SPDX-License-Identifier: Apache-2.0
// Surveys a recording: lists its content and checks whether it is complete. All parts are read, and
// every checksum is checked. Truncated files and MCAP files of other programs can be surveyed, too.
#pragma once

#include "kinalign/clock/utc_anchor.h"
#include "kinalign/core/files.h"
#include "kinalign/recording/counts.h"
#include "kinalign/recording/format.h"
#include "kinalign/recording/kinect_survey.h"
#include "kinalign/recording/record_stream.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace kinalign {

/// One channel of the recording. Channels without messages are included, so that a device without
/// data is visible.
struct ChannelSurvey {
  McapChannel channel;
  std::uint64_t messages = 0, bytes = 0;  // bytes of payload
  std::uint64_t first = 0, last = 0;      // lowest and highest log time, ns
  std::uint64_t missing = 0;              // numbers missing between the first and the last message
  std::uint32_t sensors = 0;  // sensors of a SlimeVR tracker that sent rotations, one bit each
};

/// Everything that the commands `info` and `check` print about a recording. A manifest of the
/// recording is also made from it.
struct RecordingSurvey {
  std::optional<RecordingFacts> facts;  // empty: not a recording of kinalign
  std::vector<ChannelSurvey> channels;  // sorted by topic
  std::uint64_t messages = 0;
  std::uint64_t unchecked = 0;           // messages without a checksum
  std::vector<std::string> truncated;    // paths of files without index or end
  std::vector<std::string> attachments;  // names of the attachments
  std::vector<WallClockStep> steps;      // steps of the recording machine's wall clock
  ExpectedDevices expected;
  std::map<std::string, std::string> places;  // places of nodes in lab.toml, by "imu/7"
  std::optional<RecordingEnd> end;            // empty: truncated, or continued in a missing file
  Ending ending = Ending::none;               // `truncated` if the last file is truncated
  std::vector<CountedSender> senders;         // the last counts of each sender
  std::vector<CountedPort> ports;             // the last counts of each port
  std::vector<std::pair<RecordedMark, std::uint64_t>> marks;  // marks and their log times, ns
  std::uint64_t more_marks = 0;                               // marks above most_marks, not kept
  std::uint64_t bytes = 0;                                    // size of all files
  Findings findings;
};

/// Surveys a recording from its records, for a caller that also uses the records for other
/// purposes.
class RecordingSurveyor {
 public:
  /// Takes a record. Call this for every record of the stream, in order.
  void take(const McapRecord& record) {
    std::visit([this](const auto& one) { add(one); }, record);
  }
  /// Call this after the last record of the stream. `path`: the file that findings name.
  RecordingSurvey finish(const std::string& path, const RecordStream& stream);
  /// The facts; empty until they were read.
  const std::optional<RecordingFacts>& facts() const { return survey_.facts; }

 private:
  void add(const McapChannel& channel);
  void add(const McapMetadata& metadata);
  void add(const McapAttachment& attachment);
  void add(const McapMessage& message);
  template <class Other>
  void add(const Other&) {}
  void add_own(std::string_view topic, const McapMessage& message);
  void add_mark(const McapMessage& message);

  std::map<std::uint16_t, ChannelSurvey> channels_;
  std::vector<ClockPair> clock_;
  // The last counts of each sender and each port. The key of a sender is topic, stream, address and
  // node.
  std::map<std::array<std::string, 4>, CountedSender> senders_;
  std::map<std::string, CountedPort> ports_;
  KinectSurvey kinects_;
  RecordingSurvey survey_;
};

/// A finding about a recording of kinalign that was closed properly, but does not contain the
/// recording's end. The rest may be in a file that is missing.
Findings judge_end(const std::string& path, bool is_ours, Ending ending);

/// True if a file begins as an MCAP file. Fails if the file cannot be read.
Result<bool> is_recording(FileSystem& files, const std::string& path);

}  // namespace kinalign
