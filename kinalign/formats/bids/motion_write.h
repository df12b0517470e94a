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

/// Facts for motion.json that do not follow from the samples. Empty texts are not written. The
/// names are for people; BidsEntities contains the labels for file names.
struct BidsSystemFacts {
  std::string task_name, system_name;  // such as "Walking and turning", "Kinect v2"
  double rate_hz = 0.0;                // nominal
  std::string task_description, manufacturer, model, software_versions;
};

/// The texts of the sidecar files of a motion.tsv. They are made after the rows, because they
/// contain counts and the measured rate.
struct BidsSidecars {
  std::string channels_tsv, channels_json, motion_json;
  Time onset{};  // the zero of the latencies, for scans.tsv
};

/// Writes a motion.tsv. Quaternions and latencies have nine decimals; positions, accelerations and
/// angular velocities have six. BIDS has no local rotations, so positions and orientations of a
/// skeleton are global. Missing and invalid values are n/a. The caller commits `out`, which must
/// exist longer than the writer.
class BidsMotionWriter {
 public:
  BidsMotionWriter(BidsSource source, TextOut& out);

  /// Appends the next rows. Their kind must be that of the source.
  Result<void> append(const ClipFrames& frames);
  Result<void> append(const PointFrames& frames);
  Result<void> append(const ImuSamples& samples);

  /// Call this after the last row.
  BidsSidecars sidecars(const BidsSystemFacts& facts) const;

 private:
  void begin_row(Time stamp);
  void put(std::span<const double> values, int decimals, bool present);

  BidsSource source_;
  std::vector<BidsChannel> channels_;
  TextOut* out_;
  std::uint64_t rows_ = 0;
  // The first row sets onset_. last_ is the stamp of the newest row.
  Time onset_{}, last_{};
};

}  // namespace kinalign
