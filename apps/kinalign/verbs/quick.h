// SPDX-License-Identifier: Apache-2.0
// The quick case of align: files named by flags, without a recording.toml.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <string>
#include <vector>

namespace kinalign {

struct QuickFlags {
  std::string mocap, kinect;
  std::vector<std::string> points;  // NAME=FILE
  std::vector<std::string> imu;     // NODE=FILE
  std::string kinect_layout, points_layout, imu_layout, root_node;
  StreamOptions mocap_options;
  SpaceOptions space;
  std::vector<std::string> joints;  // JOINT=JOINT

  Fields fields();  // and sets what --space is without a word: fit
};

/// Fails where one of these flags stands beside the manifest `path`, with the key that says it
/// there.
Result<void> refuse_beside(const std::string& path, const Sources& given);

/// Fails where a flag is given without the file it is for, or with another --space's.
Result<void> refuse_alone(const QuickFlags& flags, const Sources& given);

/// Fails where a value is not NAME=VALUE or a stream's name is given twice; the error's file is the
/// flag.
Result<Manifest> quick_manifest(const QuickFlags& flags);

/// Fails where a file is of another kind than its flag says.
Result<void> check_kinds(const QuickFlags& flags, const Recording& recording);

}  // namespace kinalign
