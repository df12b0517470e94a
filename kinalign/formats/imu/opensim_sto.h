// SPDX-License-Identifier: Apache-2.0
// Reads and writes OpenSim .sto files of quaternions, one column a node. Layout:
// docs/formats/imu.md.
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

/// Reads the orientations of the nodes that the columns name ("pelvis_imu"). The world is z up, as
/// OpenSense's readers of sensor exports write it, unless `up` says y. Stamps are the seconds of
/// the time column; if start_ns is given, they are shifted so that the first row gets it. A
/// DataType other than Quaternion fails.
/// A .sto holds orientations only, so the stream has no accelerations and no angular velocities.
std::unique_ptr<ImuReader> make_opensim_sto_reader(const StreamOptions& options,
                                                   std::string_view file);

bool looks_like_opensim_sto(std::string_view head);

/// The head of the file, above the rows.
struct OpensimStoHead {
  /// [S] "pelvis_imu", the names of the sensors in the OpenSim model.
  std::vector<std::string> names;
  ImuContent content;  // orientation must be present
  double rate_hz = 0.0;
  Time zero{};  // the stamp of time 0
};

/// Writes orientations, z up, to nine decimals, and times to the nanosecond. An invalid sample is
/// written as four nan. Accelerations and angular velocities are left out. The caller commits
/// `out`, which must outlive the writer.
class OpensimStoWriter {
 public:
  static Result<OpensimStoWriter> begin(const OpensimStoHead& head, TextOut& out);
  Result<void> append(const ImuSamples& samples);

 private:
  OpensimStoWriter(std::size_t nodes, Time zero, TextOut& out);

  TextOut* out_;
  std::size_t nodes_;
  Time zero_;
  // Our orientations have y up; the file has z up.
  Quat z_up_from_ours_;
};

}  // namespace kinalign
