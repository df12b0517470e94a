// SPDX-License-Identifier: Apache-2.0
// The flags of `align` that name single files, for a recording without a recording.toml.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <string>
#include <vector>

namespace kinalign {

/// The values of these flags. quick_manifest() makes the manifest that a recording.toml would give,
/// so that alignment needs only manifests. Its streams are in the order mocap, kinect, points, imu.
struct QuickFlags {
  std::string mocap, kinect;
  std::vector<std::string> points;  // NAME=FILE
  std::vector<std::string> imu;     // NODE=FILE
  std::string kinect_layout, points_layout, imu_layout, root_node;
  StreamOptions mocap_options;
  SpaceOptions space;               // how the Kinect is moved
  std::vector<std::string> joints;  // KINECT=MOCAP

  Fields fields();  // also sets the default of --space to "fit"
};

/// Fails if one of these flags was given together with the manifest `path`. The error names the key
/// of the manifest that has the same meaning.
Result<void> refuse_with_input(const std::string& path, const Sources& given);

/// Fails if a flag was given without the file that it describes, or with a method of --space that
/// does not use it.
Result<void> refuse_alone(const QuickFlags& flags, const Sources& given);

/// Makes the manifest that the flags describe. Fails if a value is not NAME=VALUE or two streams
/// have the same name; the error's file is the flag.
Result<Manifest> quick_manifest(const QuickFlags& flags);

/// Fails if the content of a file is of another kind than its flag requires.
Result<void> check_kinds(const QuickFlags& flags, const Recording& recording);

}  // namespace kinalign
