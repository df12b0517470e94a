// SPDX-License-Identifier: Apache-2.0
// The files of one recording: it goes on in NAME.part2.mcap where its disk had failed, and that one
// begins with all that the disk had not confirmed. docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/io/recording_format.h"
#include "kinalign/io/recording_survey.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The numbers of the messages in a file, by channel.
class MessageNumbers {
 public:
  void add(const McapMessage& message);
  bool has(const McapMessage& message) const;
  bool has_all(const MessageNumbers& others) const;
  void add_all(const MessageNumbers& others);
  /// Of a channel, each once.
  std::uint64_t present(std::uint16_t channel) const;
  /// Left out between the first and the last of a channel.
  std::uint64_t missing(std::uint16_t channel) const;

 private:
  using Stretches = std::map<std::uint32_t, std::uint64_t>;  // first number: behind the last one
  static void add(Stretches& stretches, std::uint32_t begin, std::uint64_t end);
  std::map<std::uint16_t, Stretches> channels_;
};

struct RecordingPart {
  std::string path;
  RecordingFacts facts;
  MessageNumbers numbers{};
  bool has_end = false;  // it says that the recording ended here, or that it is torn for good
};

/// In their order.
using RecordingParts = std::vector<RecordingPart>;

/// What stands twice is taken from the later file: of the earlier one the disk had not said that it
/// is there.
bool stands_later(const RecordingParts& parts, std::size_t part, const McapMessage& message);

/// Of the same run: parts of one recording.
bool is_same_recording(const RecordingFacts& a, const RecordingFacts& b);

/// What a file says of itself before its messages; absent where it is no recording of ours.
Result<std::optional<RecordingFacts>> read_facts(FileSystem& files, const std::string& path);

/// Reads these files once. Fails where they are not all of one recording.
Result<RecordingParts> read_parts(FileSystem& files, const std::vector<std::string>& paths,
                                  const Progress& progress);

/// These and, as they lie in the same folders, all other files of their recordings.
std::vector<std::string> with_parts(FileSystem& files, std::vector<std::string> paths);

/// The file and, as they lie in the same folder, those that its recording went on in. A file that
/// brings nothing new is left out: of one that `recover` has made all parts are.
Result<RecordingParts> parts_from(FileSystem& files, const std::string& path,
                                  const Progress& progress);

/// That the first of these is not all of its recording; the others were read with it or not.
enum class PartsBehind { left, read };
Findings judge_parts(const RecordingParts& parts, PartsBehind behind);

/// A survey of the first of these with what those behind add to it: channels, their messages, each
/// once (bytes as they stand in all), numbers that are missing in all of them, the last counts, the
/// end, marks, steps of the wall clock, which are torn, and what is wrong with any.
Result<RecordingSurvey> survey_parts(FileSystem& files, const RecordingParts& parts,
                                     const Progress& progress);

}  // namespace kinalign
