// SPDX-License-Identifier: Apache-2.0
// Writes a rehearsal (a simulated recording session) into a folder: the devices' files, the
// manifest for `align`, and the truth.
#pragma once

#include "apps/kinalign/simulate/live_rehearsal.h"

#include "kinalign/core/files.h"
#include "kinalign/simulate/rehearsal/rehearsal.h"
#include "kinalign/take/manifest.h"

#include <string>

namespace kinalign {

/// The stamps of the nodes' samples. `own`: by each node's clock. `arrival`: by the arrival of the
/// sample over a simulated radio. `received`: by each node's clock, but samples that the radio
/// loses are missing; `benchmark twin` uses it.
enum class NodeStamps { own, arrival, received };

/// The devices that recorded besides the suit.
struct DeviceChoice {
  NodeStamps stamps = NodeStamps::own;
  bool kinect = true, nodes = true;
};

/// The folder of a rehearsal. All functions below make new files in it and never replace a file.
struct RehearsalFolder {
  FileSystem& files;
  std::string path;  // an existing folder that contains a folder truth/
};

/// Writes truth/motion.bvh at 120 Hz. A spline through these frames is exact within micrometres.
Result<void> write_motion(const RehearsalFolder& folder, const Motion& motion);

/// Writes suit.bvh with one frame, as the suit's program exports it. It is needed because the live
/// stream has no skeleton.
Result<void> write_suit_head(const RehearsalFolder& folder, const Motion& motion);

/// Writes lab.toml for `record`, with the devices, their ports and names.
Result<void> write_lab(const RehearsalFolder& folder, const LiveOptions& options,
                       const Rehearsal& rehearsal);

/// The file name that `record` gives the first take in a folder, unless flags name it.
inline constexpr const char* live_take_name = "take_01.mcap";

/// Writes recording.toml, with which `align` aligns the first take that `record` makes in the
/// folder. `clockless_hz`: the rate of nodes without a counter.
Result<void> write_live_manifest(const RehearsalFolder& folder, const Rehearsal& rehearsal,
                                 std::optional<double> clockless_hz);

/// Writes truth/truth.json.
Result<void> write_truth(const RehearsalFolder& folder, const TrueRecording& truth);

/// Writes mocap.bvh, kinect.csv, imu_<node>.csv and recording.toml. In `truth` the clocks become
/// those of the files' stamps, and nodes without a file are removed.
Result<void> write_devices(const RehearsalFolder& folder, const Rehearsal& rehearsal,
                           const Motion& motion, const DeviceChoice& devices, TrueRecording& truth);

}  // namespace kinalign
