// SPDX-License-Identifier: Apache-2.0
// OpenSim .sto of quaternions, one column a node, read and written. Layout: docs/formats/imu.md.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/formats/reader.h"
#include "kinalign/motion/arrays.h"
#include "kinalign/take/manifest.h"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Orientations of the nodes that the columns name ("pelvis_imu"). The world is z up, as
/// OpenSense's readers of sensor exports write it, unless `up` says y. Seconds of the time column,
/// moved so that the first row has start_ns where that is given. Other DataTypes than Quaternion
/// fail.
std::unique_ptr<ImuReader> make_opensim_sto_reader(const StreamOptions& options,
                                                   std::string_view file);

bool looks_like_opensim_sto(std::string_view head);

/// What stands above the rows.
struct OpensimStoHead {
  std::vector<std::string> names;  // [S] "pelvis_imu", as the OpenSim model calls its sensors
  ImuContent content;              // with orientation
  double rate_hz = 0.0;
  Time zero{};  // the stamp of time 0
};

/// Writes orientations: z up, to nine decimals, seconds to the nanosecond. A sample that is not
/// valid is four nan. Accelerations and angular velocities are left out. The caller commits `out`,
/// which must outlive the writer.
class OpensimStoWriter {
 public:
  static Result<OpensimStoWriter> begin(const OpensimStoHead& head, TextOut& out);
  Result<void> append(const ImuSamples& samples);

 private:
  OpensimStoWriter(std::size_t nodes, Time zero, TextOut& out);

  TextOut* out_;
  std::size_t nodes_;
  Time zero_;
  Quat z_up_from_ours_;
};

}  // namespace kinalign
