// SPDX-License-Identifier: Apache-2.0
// Reads the sidecar files of a motion.tsv, and makes the reader that they describe. They are
// needed, because the columns of a motion.tsv have no names.
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

/// Facts from the sidecar files, which a reader of motion.tsv needs.
struct BidsSystem {
  std::vector<BidsChannel> channels;                          // one for each column
  std::map<std::string, std::optional<std::string>> letters;  // reference frame and its SpatialAxes
  double rate_hz = 0.0;
  std::optional<Time> onset;  // the zero of the latencies, from scans.tsv
};

/// Reads the sidecar files of the motion.tsv `path`. Fails if channels.tsv or motion.json is
/// missing or can't be understood; both are in the same folder. Two files are optional:
/// channels.json in the same folder, and scans.tsv in the folder above.
Result<BidsSystem> read_bids_system(FileSystem& files, const std::string& path);

/// The paths of the sidecar files that exist.
std::vector<std::string> bids_sidecar_paths(FileSystem& files, const std::string& path);

/// Makes a reader of points from POS channels. A point is missing if one of its values is n/a.
Result<std::unique_ptr<PointReader>> make_bids_point_reader(const BidsSystem& system,
                                                            const StreamOptions& options,
                                                            std::string_view file);
/// Makes a reader of inertial nodes from ORNT channels of quaternions, and from ACCEL and GYRO
/// channels. Only quantities that all nodes have are read.
Result<std::unique_ptr<ImuReader>> make_bids_node_reader(const BidsSystem& system,
                                                         const StreamOptions& options,
                                                         std::string_view file);

/// True if the file name has the form ..._tracksys-..._motion.tsv.
bool named_as_bids_motion(std::string_view path);
/// True if at least one channel has the type POS.
bool has_positions(const BidsSystem& system);

}  // namespace kinalign
