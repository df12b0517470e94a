// SPDX-License-Identifier: Apache-2.0
// A take that is being exported: its rows in the forms that writers need.
#pragma once

#include "kinalign/dataset/take_name.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"

#include <functional>
#include <string>

namespace kinalign {

/// An open take. Its rows can be read several times, because some formats need this; only one slab
/// is in memory. Stamps may be moved, so writers must take them from the rows and not from the
/// file.
class ExportedTake {
 public:
  /// `without_date`: stamps are moved so that the first one is 2000-01-01T00:00:00Z.
  static Result<ExportedTake> open(FileSystem& files, const std::string& path, TakeName name,
                                   double rate_hz, bool without_date);

  const TakeName& name() const { return name_; }
  const TakeHeader& header() const { return reader_.header(); }
  // The rate comes from the index, since a take's rows only have stamps.
  double rate_hz() const { return rate_hz_; }
  Time first() const { return first_; }      // stamp of the first row, after moving
  Duration moved() const { return moved_; }  // the time by which stamps were moved
  Result<std::string> report_json() const { return reader_.report_json(); }

  /// Reads all rows from the beginning, slab by slab. It may be called again.
  Result<void> rows(const std::function<Result<void>(const TakeSlab&)>& use);

  /// Reads the rows of one group of that kind. A point is missing if it is not valid. If a skeleton
  /// is read as points, its joints are missing in rows that are not valid. Frames of a skeleton
  /// have no validity and are passed on unchanged.
  Result<void> clip_frames(std::size_t group,
                           const std::function<Result<void>(const ClipFrames&)>& use);
  Result<void> point_frames(std::size_t group,
                            const std::function<Result<void>(const PointFrames&)>& use);
  Result<void> node_samples(std::size_t group,
                            const std::function<Result<void>(const ImuSamples&)>& use);

 private:
  ExportedTake(TakeReader reader, TakeName name, double rate_hz)
      : reader_(std::move(reader)), name_(std::move(name)), rate_hz_(rate_hz) {}

  TakeReader reader_;
  TakeName name_;
  double rate_hz_;
  Time first_{};
  Duration moved_{};
  TakeSlab slab_;
};

}  // namespace kinalign
