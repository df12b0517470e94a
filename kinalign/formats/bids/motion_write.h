// SPDX-License-Identifier: Apache-2.0
// One tracking system of a BIDS-Motion data set: motion.tsv row by row, then what stands beside it.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/formats/bids/channels.h"
#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// What nobody can count out of the samples. Empty texts are left out.
struct BidsSystemFacts {
  std::string task_name, system_name;  // "Walking and turning", "Kinect v2"
  double rate_hz = 0.0;                // nominal
  std::string task_description, manufacturer, model, serial_number, software_versions;
  /// To where x, y and z point for a person at the beginning: A or P, L or R, S or I.
  std::string spatial_axes = "LSA";
};

/// The texts of the files beside motion.tsv.
struct BidsSidecars {
  std::string channels_tsv, channels_json, motion_json;
  Time onset{};  // for scans.tsv: latencies count from here
};

/// Writes positions to a micrometre, quaternions to nine decimals, accelerations and angular
/// velocities to a millionth, latencies to a nanosecond. Positions and orientations of a skeleton
/// are global. What is missing or not valid is n/a. The caller commits `out`, which must outlive
/// the writer.
class BidsMotionWriter {
 public:
  BidsMotionWriter(BidsSource source, TextOut& out);

  /// The next rows; of the kind that the source is of.
  Result<void> append(const ClipFrames& frames);
  Result<void> append(const PointFrames& frames);
  Result<void> append(const ImuSamples& samples);

  /// After the last row.
  BidsSidecars sidecars(const BidsSystemFacts& facts) const;

 private:
  void begin_row(Time stamp);
  void put(std::span<const double> values, int decimals, bool present);

  BidsSource source_;
  std::vector<BidsChannel> channels_;
  TextOut* out_;
  std::uint64_t rows_ = 0;
  Time onset_{}, last_{};
};

}  // namespace kinalign
