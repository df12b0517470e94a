// SPDX-License-Identifier: Apache-2.0
// What stands beside a motion.tsv, and the reader that it describes.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/bids/channels.h"
#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// What a reader of motion.tsv has to know.
struct BidsSystem {
  std::vector<BidsChannel> channels;           // one for each column
  std::map<std::string, std::string> letters;  // reference frame -> SpatialAxes
  double rate_hz = 0.0;
  std::optional<Time> onset;  // of scans.tsv
};

/// channels.tsv and motion.json stand in the same folder as the motion.tsv `path`; channels.json
/// there and scans.tsv above it may be missing. Fails where one of the first two is missing or
/// can't be understood.
Result<BidsSystem> read_bids_system(FileSystem& files, const std::string& path);

/// Those of the four that are there.
std::vector<std::string> bids_sidecar_paths(FileSystem& files, const std::string& path);

/// POS channels as points. A point with n/a is missing.
Result<std::unique_ptr<PointReader>> make_bids_point_reader(const BidsSystem& system,
                                                            const StreamOptions& options,
                                                            std::string_view file);
/// ORNT of quaternions, ACCEL and GYRO as nodes. Only quantities that all nodes have are read.
Result<std::unique_ptr<ImuReader>> make_bids_node_reader(const BidsSystem& system,
                                                         const StreamOptions& options,
                                                         std::string_view file);

/// ..._tracksys-..._motion.tsv
bool named_as_bids_motion(std::string_view path);
/// Some channel is POS.
bool has_positions(const BidsSystem& system);

}  // namespace kinalign
