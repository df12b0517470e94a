// SPDX-License-Identifier: Apache-2.0
// The files that the demo's devices write about its motion. The layouts: docs/formats.
#pragma once

#include "tools/demo/body.h"

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"

#include <cstdint>
#include <string>

namespace kinalign {

struct DemoTake {
  FileSystem& files;
  std::string folder;  // ends in '/'
  double seconds = 60;
  std::uint64_t seed = 1;
  std::string subject, action;
};

/// mocap.bvh: 60 Hz, 59 joints with 6 channels each, YXZ, cm.
Result<void> write_demo_mocap(const DemoTake& take, const DemoMotion& motion);

/// kinect.csv: 30 Hz with jitter, 25 joints in the camera's space, 1 cm of noise, single frames
/// lost, two gaps, feet and hands inferred now and then.
Result<void> write_demo_kinect(const DemoTake& take, const DemoMotion& motion);

/// imu_<node>.csv, five of them: 15 Hz with jitter, samples lost; stamps within 3.6 ms of the
/// truth.
Result<void> write_demo_imus(const DemoTake& take, const DemoMotion& motion);

/// recording.toml, with all that align needs to know.
Result<void> write_demo_manifest(const DemoTake& take);

}  // namespace kinalign
