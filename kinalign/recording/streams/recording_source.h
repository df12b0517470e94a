// SPDX-License-Identifier: Apache-2.0
// An opened recording. One pass over its files hashes them, surveys them, reads the exchanges of
// all clocks and lists all senders. The streams of its devices are then read with the chunk index.
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

/// The rows of one device, in blocks. Each pass has its own place and decoder; chunks are shared
/// with other passes.
template <class FramesType>
class DevicePass {
 public:
  using Frames = FramesType;
  using Header = typename DeviceRows<Frames>::Header;

  using Channels = std::map<std::uint16_t, RawChannel>;  // channels of the device, by id

  DevicePass(MessagePass messages, std::shared_ptr<const Channels> channels,
             Duration utc_minus_host, std::unique_ptr<DeviceRows<Frames>> rows)
      : messages_(std::move(messages)),
        channels_(std::move(channels)),
        utc_minus_host_(utc_minus_host),
        rows_(std::move(rows)) {}

  /// Replaces the block by the next one. False after the last block. `progress` is called for each
  /// chunk, since many chunks may have no row.
  Result<bool> next(Frames& block, const Progress& progress = {});
  /// nullptr until the first row, if the header depends on it.
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

/// Starts a new pass from the beginning.
template <class Frames>
using DevicePasses = std::function<DevicePass<Frames>()>;

/// The stream of one device.
struct DeviceStream {
  StampSurvey survey;                               // survey of the rows' stamps
  std::shared_ptr<const std::vector<Time>> stamps;  // stamps of the rows, in their order
  TimeModel clock;                                  // converts the device's stamps to UTC
  Findings findings;  // findings about the rows themselves come with a pass
  std::variant<DevicePasses<ClipFrames>, DevicePasses<PointFrames>, DevicePasses<ImuSamples>>
      passes;
  std::variant<Skeleton, PointHeader, ImuHeader> header;
};

/// An opened recording and the answers about its devices. The first pass happens in open();
/// stream() reads a device's chunks again only if the first pass did not listen to it.
class RecordingSource {
 public:
  /// Whether streams will be read. If so, the first pass learns the devices' clocks too.
  enum class Devices { surveyed, learned };

  /// Reads all parts of the recording to which the file belongs. `wanted`: streams of a manifest
  /// that may select a body or trackers. `files` must outlive the source and the objects that it
  /// returns. An MCAP file of another program can only be surveyed.
  static Result<std::shared_ptr<RecordingSource>> open(
      FileSystem& files, const std::string& path, Devices devices,
      const std::vector<StreamOptions>& wanted = {}, const Progress& progress = {});
  RecordingSource(const RecordingSource&) = delete;
  RecordingSource& operator=(const RecordingSource&) = delete;
  ~RecordingSource() = default;

  const std::string& path() const { return state_.path; }
  const RecordingParts& parts() const { return state_.parts; }
  const RecordingSurvey& survey() const { return state_.survey; }
  /// Hash and length of each file, under the file's own name.
  const std::vector<InputFacts>& facts() const { return state_.input_facts; }
  /// Findings about the files, and the marks, which do not depend on the stream.
  const SharedFile& shared() const { return state_.shared; }

  /// The stream of select["stream"], by default of the options' name. select["node"], by default
  /// the file's node, selects an inertial node. select["sender"] and select["body"] select one of
  /// several senders or bodies (the avatar of mocap, the sensor of a SlimeVR tracker). A tracker's
  /// node is its address. Must not be called from two threads at once.
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

/// A manifest with all devices of a recording as streams. Mocap comes first, so that its stamps are
/// the grid, and a Kinect is fitted to its space. Nodes of one stream share one entry. `path`: the
/// name of the file in the manifest.
Result<Manifest> manifest_of(const RecordingSurvey& survey, const std::string& path);

}  // namespace kinalign
