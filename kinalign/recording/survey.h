// SPDX-License-Identifier: Apache-2.0
// Surveys a recording: its content and whether it is complete. All parts are read, and every
// checksum is checked. Truncated files and MCAP files of other programs can be surveyed too.
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

/// One channel of the recording. Channels without messages are included, since a device that sent
/// nothing is a fact, too.
struct ChannelSurvey {
  McapChannel channel;
  std::uint64_t messages = 0, bytes = 0;  // bytes of payload
  std::uint64_t first = 0, last = 0;      // lowest and highest log time, ns
  std::uint64_t missing = 0;              // numbers missing between the first and the last
  std::uint32_t sensors = 0;  // sensors of a SlimeVR tracker with rotations, one bit each
};

/// All that `info` and `check` say of a recording. It is also the basis of the manifest that is
/// made of it.
struct RecordingSurvey {
  std::optional<RecordingFacts> facts;  // absent: not a recording of kinalign
  std::vector<ChannelSurvey> channels;  // sorted by topic
  std::uint64_t messages = 0;
  std::uint64_t unchecked = 0;           // messages without a checksum
  std::vector<std::string> truncated;    // files without index or end
  std::vector<std::string> attachments;  // their names
  std::vector<WallClockStep> steps;      // of the recording machine's wall clock
  ExpectedDevices expected;
  std::map<std::string, std::string> places;  // places of nodes, if the lab names them, by "imu/7"
  std::optional<RecordingEnd> end;     // absent: truncated, or continued in a file that is missing
  Ending ending = Ending::none;        // `truncated` if the last file is
  std::vector<CountedSender> senders;  // the last counts of each sender
  std::vector<CountedPort> ports;      // the last counts of each port
  std::vector<std::pair<RecordedMark, std::uint64_t>> marks;  // with their log times, ns
  std::uint64_t more_marks = 0;                               // marks beyond most_marks
  std::uint64_t bytes = 0;                                    // of all files
  Findings findings;
};

/// Surveys a recording from its records, for a caller that reads them for other purposes too.
class RecordingSurveyor {
 public:
  /// Takes a record. Call for every record of the stream, in order.
  void take(const McapRecord& record) {
    std::visit([this](const auto& one) { add(one); }, record);
  }
  /// Call after the last record of the stream. `path`: the file to name in findings.
  RecordingSurvey finish(const std::string& path, const RecordStream& stream);
  /// Absent until they were read.
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
  // The last counts of each sender, by topic, stream, address and node, and of each port.
  std::map<std::array<std::string, 4>, CountedSender> senders_;
  std::map<std::string, CountedPort> ports_;
  KinectSurvey kinects_;
  RecordingSurvey survey_;
};

/// Reports a recording of kinalign that was closed properly but does not end: the rest, if a disk
/// stored it, is missing.
Findings judge_end(const std::string& path, bool is_ours, Ending ending);

/// Returns whether a file begins as an MCAP file. Fails if it cannot be read.
Result<bool> is_recording(FileSystem& files, const std::string& path);

}  // namespace kinalign
