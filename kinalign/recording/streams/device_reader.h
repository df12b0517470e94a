// SPDX-License-Identifier: Apache-2.0
// A device of a recording as a stream of rows: docs/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/survey.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// A device that was listened to, and readers of its rows.
struct RecordedDevice {
  std::shared_ptr<const HeardDevice> heard;
  std::function<Result<AnyReader>()> make;
  std::vector<std::string> further_files;  // the recording went on in them, and they are read
  SaidByFile by_file;                      // by all these files, whichever device is read
};

/// Reads the file once, and those that the recording went on in: by itself it looks for them in the
/// same folder. The stream is select["stream"], by default the one of the options' name;
/// select["node"], by default the file's node, says which inertial node, select["sender"] and
/// select["body"] (of mocap the avatar, of a
/// SlimeVR tracker the sensor) which of several. A tracker's node is its address.
Result<RecordedDevice> listen(FileSystem& files, const StreamOptions& options,
                              const StreamFile& file, const Progress& progress);

/// All devices of a recording as streams of a manifest: mocap first, whose stamps are then the
/// grid, and a Kinect is fitted into its space; nodes that are one stream share it. `path` as the
/// manifest shall name the file.
Result<Manifest> manifest_of(const RecordingSurvey& survey, const std::string& path);

}  // namespace kinalign
