// SPDX-License-Identifier: Apache-2.0
// Writes one tracking system of a BIDS-Motion data set: motion.tsv row by row, then the texts of
// its sidecar files.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/formats/bids/channels.h"
#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// Facts for motion.json that can't be computed from the samples. Empty texts are left out.
/// Names for people; the labels of BidsEntities are for file names.
struct BidsSystemFacts {
  std::string task_name, system_name;  // "Walking and turning", "Kinect v2"
  double rate_hz = 0.0;                // nominal
  std::string task_description, manufacturer, model, software_versions;
};

/// The texts of the sidecar files of a motion.tsv.
/// The texts are made after the rows, because they state counts and the measured rate.
struct BidsSidecars {
  std::string channels_tsv, channels_json, motion_json;
  Time onset{};  // for scans.tsv: time zero of the latencies
};

/// Writes a motion.tsv. Positions have six decimals, quaternions nine, accelerations and angular
/// velocities six, latencies nine. Positions and orientations of a skeleton are global. Missing and
/// invalid values are n/a. The caller commits `out`, which must outlive the writer.
/// BIDS has no local rotations, so a skeleton is written in the room's space.
class BidsMotionWriter {
 public:
  BidsMotionWriter(BidsSource source, TextOut& out);

  /// Appends the next rows. Their kind must match that of the source.
  Result<void> append(const ClipFrames& frames);
  Result<void> append(const PointFrames& frames);
  Result<void> append(const ImuSamples& samples);

  /// Call after the last row.
  BidsSidecars sidecars(const BidsSystemFacts& facts) const;

 private:
  void begin_row(Time stamp);
  void put(std::span<const double> values, int decimals, bool present);

  BidsSource source_;
  std::vector<BidsChannel> channels_;
  TextOut* out_;
  std::uint64_t rows_ = 0;
  // onset_ is set by the first row; last_ is the stamp of the newest one.
  Time onset_{}, last_{};
};

}  // namespace kinalign
