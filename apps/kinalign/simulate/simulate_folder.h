// SPDX-License-Identifier: Apache-2.0
// A rehearsal in a folder: the devices' files, the manifest for align, and the truth.
#pragma once

#include "apps/kinalign/simulate/live_rehearsal.h"

#include "kinalign/core/files.h"
#include "kinalign/simulate/rehearsal/rehearsal.h"
#include "kinalign/take/manifest.h"

#include <string>

namespace kinalign {

/// What nodes' samples are stamped by: each node's own clock, or their arrival over a link.
/// `received`: by their own clocks, without the samples that the link loses.
enum class NodeStamps { own, arrival, received };

/// The devices that recorded together with the suit.
struct DeviceChoice {
  NodeStamps stamps = NodeStamps::own;
  bool kinect = true, nodes = true;
};

struct RehearsalFolder {
  FileSystem& files;
  std::string path;  // is there, and has a folder truth/ in it
};

/// truth/motion.bvh, 120 Hz: enough that a spline through it is within micrometres.
Result<void> write_motion(const RehearsalFolder& folder, const Motion& motion);

/// suit.bvh, one frame: what the suit's program exports, since its stream has no skeleton.
Result<void> write_suit_head(const RehearsalFolder& folder, const Motion& motion);

/// lab.toml for `record`: the devices, where they send to, what they are called.
Result<void> write_lab(const RehearsalFolder& folder, const LiveOptions& options,
                       const Rehearsal& rehearsal);

/// As `record` names the first take in a folder, where no flag says otherwise.
inline constexpr const char* live_take_name = "take_01.mcap";

/// recording.toml for `align`, of the first take that `record` makes in the folder. `clockless_hz`:
/// the rate of nodes without a counter.
Result<void> write_live_manifest(const RehearsalFolder& folder, const Rehearsal& rehearsal,
                                 std::optional<double> clockless_hz);

/// truth/truth.json.
Result<void> write_truth(const RehearsalFolder& folder, const TrueRecording& truth);

/// mocap.bvh, kinect.csv, imu_<node>.csv and recording.toml. `truth` gets the clocks that the
/// files' stamps have, and loses nodes that were not there.
Result<void> write_devices(const RehearsalFolder& folder, const Rehearsal& rehearsal,
                           const Motion& motion, const DeviceChoice& devices, TrueRecording& truth);

}  // namespace kinalign
