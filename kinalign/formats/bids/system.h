// SPDX-License-Identifier: Apache-2.0
// Reads the sidecar files of a motion.tsv and makes the reader that they describe.
// A motion.tsv alone means nothing: its columns have no names.
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

/// Facts from the sidecar files that a reader of motion.tsv needs.
struct BidsSystem {
  std::vector<BidsChannel> channels;                          // one for each column
  std::map<std::string, std::optional<std::string>> letters;  // reference frame -> SpatialAxes
  double rate_hz = 0.0;
  std::optional<Time> onset;  // time zero of the latencies, from scans.tsv
};

/// Reads the sidecar files of the motion.tsv `path`. channels.tsv and motion.json lie in its
/// folder; reading fails if one of them is missing or can't be understood. channels.json, in the
/// same folder, and scans.tsv, one folder up, are optional.
Result<BidsSystem> read_bids_system(FileSystem& files, const std::string& path);

/// Paths of those of the four sidecar files that exist.
std::vector<std::string> bids_sidecar_paths(FileSystem& files, const std::string& path);

/// Reads POS channels as points. A point with an n/a is missing.
Result<std::unique_ptr<PointReader>> make_bids_point_reader(const BidsSystem& system,
                                                            const StreamOptions& options,
                                                            std::string_view file);
/// Reads ORNT channels of quaternions, ACCEL and GYRO channels as nodes. Only quantities that all
/// nodes have are read.
Result<std::unique_ptr<ImuReader>> make_bids_node_reader(const BidsSystem& system,
                                                         const StreamOptions& options,
                                                         std::string_view file);

/// True for a name of the form ..._tracksys-..._motion.tsv.
bool named_as_bids_motion(std::string_view path);
/// True if at least one channel is POS.
bool has_positions(const BidsSystem& system);

}  // namespace kinalign
