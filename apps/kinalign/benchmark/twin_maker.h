// SPDX-License-Identifier: Apache-2.0
// Makes one take of a twin by the whole chain: motion, the devices' files, alignment, take.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/build.h"
#include "kinalign/dataset/twin/twin_plan.h"
#include "kinalign/motion/pose.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The truth's file below the data set's folder: "truth/sub-03_task-S2A03_run-01.json".
std::string twin_truth_path(const TakeName& name);

/// The data set and the input for its takes. `folder` must contain a folder truth/.
/// All members must outlive the maker, which only holds this structure of references.
struct TwinPlace {
  FileSystem& files;
  const std::string& folder;
  const Catalogue& catalogue;
  const std::vector<std::string>& motions;  // BVH files; empty: only the built-in person
};

/// Makes the takes of one data set. Several threads may make takes at once.
/// A take depends only on its plan and its number, so threads may make takes in any order and the
/// bytes are the same.
class TwinMaker {
 public:
  explicit TwinMaker(const TwinPlace& place) : place_(place), takes_(place.files, place.folder) {}

  /// The summary of a take that exists with all its bytes; absent: the take has to be made.
  /// The summary is the last file that make() writes. A take that was interrupted has none and is
  /// made again.
  std::optional<TakeSummary> known(const TwinTake& take) const;
  /// Writes the truth, the take and its summary, in this order, and deletes the devices' files.
  /// `number`: the take's index in the plan. If there are motion files, every second take has the
  /// motion of one, on the body of the take's person.
  Result<TakeSummary> make(const TwinTake& take, std::size_t number, const Progress& progress);

 private:
  /// A motion, and its name in the truth.
  struct Named {
    Motion motion;
    std::string name;
  };
  Result<Named> motion_of(const TwinTake& take, std::size_t number) const;
  // `length_s` includes the time of the clicks before the suit's start.
  Result<Motion> built_in(const TwinTake& take, double length_s) const;
  Result<Motion> carried(const TwinTake& take, double length_s, const std::string& file) const;
  double height_m(const TwinTake& take) const;

  TwinPlace place_;
  TakeMaker takes_;
};

}  // namespace kinalign
