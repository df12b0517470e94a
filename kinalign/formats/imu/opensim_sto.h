// SPDX-License-Identifier: Apache-2.0
// Reads and writes OpenSim .sto files of quaternions, with one column per node. Layout:
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

/// Reads the orientations of the nodes that the columns name, such as "pelvis_imu". The world is z
/// up, as in the files that OpenSense makes from sensor exports, unless the option `up` is y.
/// Stamps are the seconds in the time column. If start_ns is given, they are shifted so that the
/// first row has this stamp. A DataType other than Quaternion is an error. A .sto file contains
/// only orientations, so the stream has no accelerations and no angular velocities.
std::unique_ptr<ImuReader> make_opensim_sto_reader(const StreamOptions& options,
                                                   std::string_view file);

bool looks_like_opensim_sto(std::string_view head);

/// The head of a file.
struct OpensimStoHead {
  /// [S] the names of the sensors in the OpenSim model, such as "pelvis_imu".
  std::vector<std::string> names;
  ImuContent content;  // orientation must be present
  double rate_hz = 0.0;
  Time zero{};  // the stamp that becomes time 0
};

/// Writes orientations with z up and nine decimals, and times to the nanosecond. An invalid sample
/// is written as four nan. Accelerations and angular velocities are left out. The caller commits
/// `out`, which must exist longer than the writer.
class OpensimStoWriter {
 public:
  static Result<OpensimStoWriter> begin(const OpensimStoHead& head, TextOut& out);
  Result<void> append(const ImuSamples& samples);

 private:
  OpensimStoWriter(std::size_t nodes, Time zero, TextOut& out);

  TextOut* out_;
  std::size_t nodes_;
  Time zero_;
  // Rotates kinalign's world (y up) to the file's world (z up).
  Quat z_up_from_ours_;
};

}  // namespace kinalign
