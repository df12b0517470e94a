// SPDX-License-Identifier: Apache-2.0
// A rehearsal in a folder: the devices' files, the manifest for align, and the truth.
#pragma once

#include "apps/kinalign/simulate/live_rehearsal.h"

#include "kinalign/core/files.h"
#include "kinalign/simulate/rehearsal/rehearsal.h"
#include "kinalign/take/manifest.h"

#include <string>

namespace kinalign {

/// The stamps of nodes' samples: by each node's own clock, or by their arrival over a link.
/// `received`: by the node's own clock, without the samples that the link loses.
/// `received` is used by `benchmark twin`, whose takes have the losses of the paper's radio.
enum class NodeStamps { own, arrival, received };

/// The devices that recorded together with the suit.
struct DeviceChoice {
  NodeStamps stamps = NodeStamps::own;
  bool kinect = true, nodes = true;
};

/// All writers below make new files in this folder and never replace one.
struct RehearsalFolder {
  FileSystem& files;
  std::string path;  // exists, and contains a folder truth/
};

/// Writes truth/motion.bvh at 120 Hz; a spline through its frames is then right within micrometres.
Result<void> write_motion(const RehearsalFolder& folder, const Motion& motion);

/// Writes suit.bvh with one frame, as exported by the suit's program, whose stream has no skeleton.
Result<void> write_suit_head(const RehearsalFolder& folder, const Motion& motion);

/// Writes lab.toml for `record`: the devices, their ports and names.
Result<void> write_lab(const RehearsalFolder& folder, const LiveOptions& options,
                       const Rehearsal& rehearsal);

/// The name that `record` gives the first take in a folder without flags for it.
inline constexpr const char* live_take_name = "take_01.mcap";

/// Writes recording.toml for `align`, for the first take that `record` makes in the folder.
/// `clockless_hz`: the rate of nodes without a counter.
Result<void> write_live_manifest(const RehearsalFolder& folder, const Rehearsal& rehearsal,
                                 std::optional<double> clockless_hz);

/// Writes truth/truth.json.
Result<void> write_truth(const RehearsalFolder& folder, const TrueRecording& truth);

/// Writes mocap.bvh, kinect.csv, imu_<node>.csv and recording.toml. `truth` gets the clocks of the
/// files' stamps, and loses nodes that did not record.
Result<void> write_devices(const RehearsalFolder& folder, const Rehearsal& rehearsal,
                           const Motion& motion, const DeviceChoice& devices, TrueRecording& truth);

}  // namespace kinalign
