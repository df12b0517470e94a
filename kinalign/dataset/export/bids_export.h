// SPDX-License-Identifier: Apache-2.0
// A whole data set as BIDS-Motion (docs/formats/bids.md), take by take, then what stands above.
#pragma once

#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/export/exported_take.h"
#include "kinalign/dataset/export/take_files.h"
#include "kinalign/formats/bids/dataset.h"
#include "kinalign/formats/bids/motion_write.h"

#include <map>

namespace kinalign {

class BidsExport {
 public:
  /// `folder`: of the new data set. `released`: no height, weight and the like in participants.tsv,
  /// and no date in scans.tsv.
  BidsExport(FileSystem& files, std::string folder, const Catalogue& catalogue, bool released)
      : files_(files), folder_(std::move(folder)), catalogue_(catalogue), released_(released) {}

  /// A tracking system for each stream.
  Result<FilesMade> add(ExportedTake& take);
  /// The description, participants and scans. Then all is read again and checked.
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
  std::map<std::string, std::vector<BidsScan>> scans_;  // of each subject
};

}  // namespace kinalign
