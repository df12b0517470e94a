// SPDX-License-Identifier: Apache-2.0
// An opened recording. The first pass over its files hashes and surveys them, learns all clocks and
// lists all senders. Later passes read the devices' streams with the index of the chunks.
// docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/recording_scan.h"
#include "kinalign/recording/streams/stored_chunks.h"
#include "kinalign/recording/survey.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace kinalign {

/// Makes the rows of one device, in blocks. Each pass has its own position and decoder, but shares
/// chunks with other passes.
template <class FramesType>
class DevicePass {
 public:
  using Frames = FramesType;
  using Header = typename DeviceRows<Frames>::Header;

  using Channels = std::map<std::uint16_t, RawChannel>;  // the device's channels by id

  DevicePass(MessagePass messages, std::shared_ptr<const Channels> channels,
             Duration utc_minus_host, std::unique_ptr<DeviceRows<Frames>> rows)
      : messages_(std::move(messages)),
        channels_(std::move(channels)),
        utc_minus_host_(utc_minus_host),
        rows_(std::move(rows)) {}

  /// Replaces `block` by the next block. Returns false after the last block. `progress` is called
  /// for each chunk, because many chunks may give no row.
  Result<bool> next(Frames& block, const Progress& progress = {});
  /// The header; nullptr before the first row if the header depends on that row.
  const Header* header() const { return rows_->header(); }
  /// The findings are complete after the last block.
  const Findings& findings() const { return rows_->findings; }

 private:
  MessagePass messages_;
  std::shared_ptr<const Channels> channels_;
  Duration utc_minus_host_;
  std::unique_ptr<DeviceRows<Frames>> rows_;
  bool ended_ = false;
};

/// A function that starts a new pass at the beginning.
template <class Frames>
using DevicePasses = std::function<DevicePass<Frames>()>;

/// The stream of one device, with everything that an alignment needs.
struct DeviceStream {
  StampSurvey survey;                               // about the stamps of the rows
  std::shared_ptr<const std::vector<Time>> stamps;  // the stamp of each row, in order
  TimeModel clock;                                  // converts the device's time to UTC
  Findings findings;  // a pass has the findings about the rows themselves
  std::variant<DevicePasses<ClipFrames>, DevicePasses<PointFrames>, DevicePasses<ImuSamples>>
      passes;
  std::variant<Skeleton, PointHeader, ImuHeader> header;
};

/// An opened recording and its devices. open() makes the first pass. stream() reads a device's
/// chunks again only if that pass had no listener for the device.
class RecordingSource {
 public:
  /// `learned`: the first pass also learns the devices' clocks, because streams will be read.
  enum class Devices { surveyed, learned };

  /// Reads all parts of the recording to which the file belongs. `wanted`: the streams of a
  /// manifest, which may select a body or trackers. `files` must exist longer than the source and
  /// the objects that it returns. An MCAP file of another program can only be surveyed.
  static Result<std::shared_ptr<RecordingSource>> open(
      FileSystem& files, const std::string& path, Devices devices,
      const std::vector<StreamOptions>& wanted = {}, const Progress& progress = {});
  RecordingSource(const RecordingSource&) = delete;
  RecordingSource& operator=(const RecordingSource&) = delete;
  ~RecordingSource() = default;

  const std::string& path() const { return state_.path; }
  const RecordingParts& parts() const { return state_.parts; }
  const RecordingSurvey& survey() const { return state_.survey; }
  /// The hash and the length of each file, with the file's name.
  const std::vector<InputFacts>& facts() const { return state_.input_facts; }
  /// The marks, and findings about the files. They are the same for all streams.
  const SharedFile& shared() const { return state_.shared; }

  /// The stream of one device. For the keys of `options.select` see request_of() in device_rows.h.
  /// Must not be called from two threads at once.
  Result<DeviceStream> stream(const StreamOptions& options, const StreamFile& file,
                              const Progress& progress = {});

  const std::vector<JsonChannel>& json_channels() const { return state_.json; }
  MessagePass messages_of(std::vector<std::uint16_t> channels) const {
    return {state_.chunks, std::move(channels)};
  }

 private:
  explicit RecordingSource(ScannedRecording state) : state_(std::move(state)) {}
  ScannedRecording state_;
};

/// A manifest with all devices of a recording as streams. Mocap comes first, so that its stamps
/// become the times of the take. A Kinect is fitted to the space of the mocap. The nodes of one
/// stream share one entry. `path`: the file's name in the manifest.
Result<Manifest> manifest_of(const RecordingSurvey& survey, const std::string& path);

}  // namespace kinalign
