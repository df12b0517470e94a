// SPDX-License-Identifier: Apache-2.0
// A recording, opened once: one pass over its files hashes them, surveys them, reads the exchanges
// of all clocks and lists all senders. Its devices' streams are then read by the chunk index.
// docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/streams/device_rows.h"
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

struct ScannedRecording;

/// Rows of one device, in blocks.
template <class FramesType>
class DevicePass {
 public:
  using Frames = FramesType;
  using Header = typename DeviceRows<Frames>::Header;

  using Channels = std::map<std::uint16_t, RawChannel>;  // of the device, by id

  DevicePass(MessagePass messages, std::shared_ptr<const Channels> channels,
             Duration utc_minus_host, std::unique_ptr<DeviceRows<Frames>> rows)
      : messages_(std::move(messages)),
        channels_(std::move(channels)),
        utc_minus_host_(utc_minus_host),
        rows_(std::move(rows)) {}

  /// Replaces the block by the next one; false behind the last. `progress` is told of each chunk,
  /// since many may have no row.
  Result<bool> next(Frames& block, const Progress& progress = {});
  /// nullptr while the first row has not come that has to say it.
  const Header* header() const { return rows_->header(); }
  /// Complete after the last block.
  const Findings& findings() const { return rows_->findings; }

 private:
  MessagePass messages_;
  std::shared_ptr<const Channels> channels_;
  Duration utc_minus_host_;
  std::unique_ptr<DeviceRows<Frames>> rows_;
  bool ended_ = false;
};

/// Starts a new pass from the front.
template <class Frames>
using DevicePasses = std::function<DevicePass<Frames>()>;

/// One device's stream.
struct DeviceStream {
  StampSurvey survey;                               // of its rows' stamps
  std::shared_ptr<const std::vector<Time>> stamps;  // of its rows, in their order
  TimeModel clock;                                  // from the device's stamps to UTC
  Findings findings;                                // those of its rows come with a pass
  std::variant<DevicePasses<ClipFrames>, DevicePasses<PointFrames>, DevicePasses<ImuSamples>>
      passes;
  std::variant<Skeleton, PointHeader, ImuHeader> header;
  std::string skeleton_path;  // of the BVH that the options name; empty: none
};

class RecordingSource {
 public:
  /// Whether streams will be asked for: then the pass learns the devices' clocks, too.
  enum class Devices { unheard, heard };

  /// Reads the file and, as they lie in the same folder, those that its recording went on in.
  /// `wanted`: streams of a manifest that may ask for a body or for trackers. `files` must outlive
  /// the source and what it hands out. An MCAP file of another program can be surveyed alone.
  static Result<std::shared_ptr<RecordingSource>> open(
      FileSystem& files, const std::string& path, Devices devices,
      const std::vector<StreamOptions>& wanted = {}, const Progress& progress = {});
  RecordingSource(const RecordingSource&) = delete;
  RecordingSource& operator=(const RecordingSource&) = delete;
  ~RecordingSource();

  const std::string& path() const;
  const RecordingParts& parts() const;
  /// Of the first file alone, and of all of them as one.
  const RecordingSurvey& first_survey() const;
  RecordingSurvey survey() const;
  /// Hash and length of each file, under the file's own name.
  const std::vector<InputFacts>& facts() const;
  /// What is wrong with the files, and the marks in them, whichever stream is read.
  SharedFile shared() const;

  /// The stream of select["stream"], by default of the options' name; select["node"], by default
  /// the file's node, says which inertial node, select["sender"] and select["body"] (of mocap the
  /// avatar, of a SlimeVR tracker the sensor) which of several. A tracker's node is its address.
  /// Not to be called on two threads at once.
  Result<DeviceStream> stream(const StreamOptions& options, const StreamFile& file,
                              const Progress& progress = {});

  const std::vector<JsonChannel>& json_channels() const;
  MessagePass messages_of(std::vector<std::uint16_t> channels) const;

 private:
  explicit RecordingSource(ScannedRecording state);
  std::unique_ptr<ScannedRecording> state_;
};

/// All devices of a recording as streams of a manifest: mocap first, whose stamps are then the
/// grid, and a Kinect is fitted into its space; nodes that are one stream share it. `path` as the
/// manifest shall name the file.
Result<Manifest> manifest_of(const RecordingSurvey& survey, const std::string& path);

}  // namespace kinalign
