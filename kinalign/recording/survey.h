// SPDX-License-Identifier: Apache-2.0
// Surveys a recording's file: its content and whether it is complete. The file is read once from
// beginning to end, and every checksum is checked. Truncated files and MCAP files of other programs
// can be surveyed too.
#pragma once

#include "kinalign/clock/utc_anchor.h"
#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/mcap/reader.h"
#include "kinalign/recording/counts.h"
#include "kinalign/recording/format.h"
#include "kinalign/recording/message_numbers.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

struct ChannelSurvey {
  McapChannel channel;
  std::uint64_t messages = 0, bytes = 0;  // bytes of payload
  std::uint64_t first = 0, last = 0;      // lowest and highest log time, ns
  std::uint64_t missing = 0;              // numbers missing between the first and the last
  std::uint32_t last_number = 0;
  bool in_order = true;       // each number is higher than the one before
  std::uint32_t sensors = 0;  // sensors of a SlimeVR tracker with rotations, one bit each
};

struct RecordingSurvey {
  std::optional<RecordingFacts> facts;  // absent: not a recording of kinalign
  std::vector<ChannelSurvey> channels;  // sorted by topic
  std::uint64_t messages = 0;
  std::uint64_t unchecked = 0;           // messages without a checksum
  std::uint32_t contents = 0;            // CRC-32 of all messages, see add_to()
  std::vector<std::string> torn;         // files without index or end
  std::vector<std::string> attachments;  // their names
  std::vector<WallClockStep> steps;      // of the recording machine's wall clock
  ExpectedDevices expected;
  std::map<std::string, std::string> places;  // places of nodes, if the lab names them, by "imu/7"
  std::optional<RecordingEnd> end;            // absent: truncated, or continued in another file
  Ending ending = Ending::none;               // `torn` for a truncated file
  std::vector<CountedSender> senders;         // the last counts of each sender
  std::vector<CountedPort> ports;             // the last counts of each port
  std::vector<std::pair<RecordedMark, std::uint64_t>> marks;  // with their log times, ns
  std::uint64_t more_marks = 0;                               // marks beyond most_marks
  std::uint64_t bytes = 0;                                    // of the file
  Findings findings;
  bool flawed = false;  // the reader reported damage or a truncated end
};

/// Surveys one file from its records, for a caller that reads them for other purposes too.
class RecordingSurveyor {
 public:
  /// `reader`: the reader of the records; it must outlive the surveyor.
  explicit RecordingSurveyor(const McapReader& reader);
  RecordingSurveyor(const RecordingSurveyor&) = delete;
  RecordingSurveyor& operator=(const RecordingSurveyor&) = delete;
  ~RecordingSurveyor();

  /// Takes a record. Call for every record of the file, in order.
  void take(const McapRecord& record);
  /// Call after the last record. `bytes`: size of the file.
  RecordingSurvey finish(const std::string& path, std::uint64_t bytes);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// The CRC-32 of messages, in their order: channel, number, both times and payload of each.
std::uint32_t add_to(std::uint32_t contents, const McapMessage& message);

/// Reports messages at a truncated end that were left out.
Findings judge_strays(const std::string& path, const NumberGuard& guard);

/// The finding for a recording of kinalign that was closed properly but does not end: the rest, if
/// a disk stored it, is missing.
Finding ends_before(const std::string& path);
/// Reports a recording without an end, see ends_before().
Findings judge_end(const std::string& path, const RecordingSurvey& survey);
/// Reports a channel of kinalign whose messages are out of order. The causes are files that recover
/// made and that lack messages of other files, or impossible numbers in a file without checksums.
Findings judge_order(const std::string& path, const RecordingSurvey& survey);

/// Fails if the file cannot be read or is not an MCAP file.
Result<RecordingSurvey> survey_recording(FileSystem& files, const std::string& path,
                                         const Progress& progress = {});

/// Pieces of a file, one per call; empty at its end.
struct PieceSource {
  std::string path;
  std::uint64_t size = 0;
  std::function<Result<std::string_view>()> next;
};
/// The same for a file that is not complete yet, or has no name.
Result<RecordingSurvey> survey_recording(const PieceSource& source, const Progress& progress = {});

/// Passes every record to `take`, in the file's order. Findings stay in `reader`.
using TakeRecord = std::function<Result<void>(const McapRecord&)>;
Result<void> read_recording(const PieceSource& source, McapReader& reader, const TakeRecord& take,
                            const Progress& progress = {});
Result<void> read_recording(FileSystem& files, const std::string& path, McapReader& reader,
                            const TakeRecord& take, const Progress& progress = {});

/// Returns whether a file begins as an MCAP file. Fails if it cannot be read.
Result<bool> is_recording(FileSystem& files, const std::string& path);

}  // namespace kinalign
