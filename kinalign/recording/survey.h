// SPDX-License-Identifier: Apache-2.0
// What is in a recording's file, and whether all of it: read once from front to end, every checksum
// checked. Works on torn files and on MCAP files of others, too.
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
  std::uint64_t messages = 0, bytes = 0;  // of payload
  std::uint64_t first = 0, last = 0;      // log time, the least and the greatest, ns
  std::uint64_t missing = 0;              // numbers left out between the first and the last
  std::uint32_t last_number = 0;
  bool in_order = true;       // each number above the one before
  std::uint32_t sensors = 0;  // of a SlimeVR tracker, a bit each: rotations came of it
};

struct RecordingSurvey {
  std::optional<RecordingFacts> facts;  // absent: not ours
  std::vector<ChannelSurvey> channels;  // by topic
  std::uint64_t messages = 0;
  std::uint64_t unchecked = 0;           // of these without a checksum
  std::uint32_t contents = 0;            // CRC-32 of all messages, see add_to()
  std::vector<std::string> torn;         // files whose index or end is not there
  std::vector<std::string> attachments;  // names
  std::vector<WallClockStep> steps;      // of the recording machine's wall clock
  ExpectedDevices expected;
  std::map<std::string, std::string> places;  // of nodes, as far as the lab says them: "imu/7"
  std::optional<RecordingEnd> end;            // absent: torn, or it goes on in another file
  Ending ending = Ending::none;               // of a file that breaks off: torn
  std::vector<CountedSender> senders;         // the last counts of each, …
  std::vector<CountedPort> ports;             // … and of each device's port
  std::vector<std::pair<RecordedMark, std::uint64_t>> marks;  // with their log times
  std::uint64_t more_marks = 0;                               // than are looked at
  std::uint64_t bytes = 0;                                    // of the file
  Findings findings;
  bool flawed = false;  // the reader found something of these: damage, or a torn end
};

/// Surveys one file from its records, for a caller that reads them for other purposes too.
class RecordingSurveyor {
 public:
  /// `reader`: that the records come from; it must outlive the surveyor.
  explicit RecordingSurveyor(const McapReader& reader);
  RecordingSurveyor(const RecordingSurveyor&) = delete;
  RecordingSurveyor& operator=(const RecordingSurveyor&) = delete;
  ~RecordingSurveyor();

  /// Every record of the file, in its order.
  void take(const McapRecord& record);
  /// After the last record. `bytes`: of the file.
  RecordingSurvey finish(const std::string& path, std::uint64_t bytes);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// The CRC-32 of messages: channel, number, both times and payload of each, in their order.
std::uint32_t add_to(std::uint32_t contents, const McapMessage& message);

/// That messages of a recording's torn end were left out, where some were.
Findings judge_strays(const std::string& path, const NumberGuard& guard);

/// Of a recording of ours that was closed in order, but not because it ended: that the rest, if a
/// disk took it, is missing.
Finding ends_before(const std::string& path);
/// That, where it is so.
Findings judge_end(const std::string& path, const RecordingSurvey& survey);
/// That messages of a channel of ours stand behind later ones, where it is so. Files that recover
/// has made and that lack what is in others bring this about, and garbage numbers in a file of
/// which no checksum covers anything.
Findings judge_order(const std::string& path, const RecordingSurvey& survey);

/// Fails where the file can't be read or is no MCAP file.
Result<RecordingSurvey> survey_recording(FileSystem& files, const std::string& path,
                                         const Progress& progress = {});

/// Pieces of a file, one a call; empty at its end.
struct PieceSource {
  std::string path;
  std::uint64_t size = 0;
  std::function<Result<std::string_view>()> next;
};
/// The same of a file that is not complete yet, or has no name.
Result<RecordingSurvey> survey_recording(const PieceSource& source, const Progress& progress = {});

/// Hands every record to `take`, in the file's order. What the reader found is left in `reader`.
using TakeRecord = std::function<Result<void>(const McapRecord&)>;
Result<void> read_recording(const PieceSource& source, McapReader& reader, const TakeRecord& take,
                            const Progress& progress = {});
Result<void> read_recording(FileSystem& files, const std::string& path, McapReader& reader,
                            const TakeRecord& take, const Progress& progress = {});

/// Whether a file begins as MCAP does. Fails where it can't be read.
Result<bool> is_recording(FileSystem& files, const std::string& path);

}  // namespace kinalign
