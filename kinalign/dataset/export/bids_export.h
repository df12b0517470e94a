// SPDX-License-Identifier: Apache-2.0
// Writes a whole data set as BIDS-Motion (docs/formats/bids.md): take by take, then the files of
// the whole set.
#pragma once

#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/export/exported_take.h"
#include "kinalign/dataset/export/take_files.h"
#include "kinalign/formats/bids/dataset.h"
#include "kinalign/formats/bids/motion_write.h"

#include <map>

namespace kinalign {

/// One export. Takes are added one by one and written at once; participants and scans are collected
/// and written by finish(). `catalogue` must outlive the object.
class BidsExport {
 public:
  /// `folder`: the folder of the new data set. If `released`, participants.tsv has no height,
  /// weight and similar columns, and scans.tsv has no dates.
  BidsExport(FileSystem& files, std::string folder, const Catalogue& catalogue, bool released)
      : files_(files), folder_(std::move(folder)), catalogue_(catalogue), released_(released) {}

  /// Adds a take; each stream becomes a tracking system.
  Result<FilesMade> add(ExportedTake& take);
  /// Writes the description, participants and scans, then reads everything again and checks it.
  Result<Findings> finish();

 private:
  Result<void> write(const std::string& path, std::string_view text);
  Result<BidsSidecars> write_motion(ExportedTake& take, std::size_t group, const std::string& path);
  Result<void> add_system(ExportedTake& take, std::size_t group, FilesMade& made);
  BidsParticipants participants() const;

  FileSystem& files_;
  std::string folder_;
  const Catalogue& catalogue_;
  bool released_;
  std::map<std::string, std::vector<BidsScan>> scans_;  // by subject
};

}  // namespace kinalign
