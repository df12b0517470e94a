// SPDX-License-Identifier: Apache-2.0
// Makes one take of a simulated data set (a twin): a motion, the devices' files, and their
// alignment.
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

/// The file of a take's truth, in the data set's folder: "truth/sub-03_task-S2A03_run-01.json".
std::string twin_truth_path(const TakeName& name);

/// The data set, and the input for its takes. `folder` must contain a folder truth/. The members
/// are references; what they refer to must live longer than the maker.
struct TwinPlace {
  FileSystem& files;
  const std::string& folder;
  const Catalogue& catalogue;
  const std::vector<std::string>& motions;  // BVH files; empty: all motions are built-in ones
};

/// Makes the takes of one data set, also in several threads at once. The bytes of a take depend
/// only on its plan and its number, so the order does not matter.
class TwinMaker {
 public:
  explicit TwinMaker(const TwinPlace& place) : place_(place), takes_(place.files, place.folder) {}

  /// The summary of a complete take. Empty if the take has to be made. make() writes the summary
  /// last, so a take whose making was stopped has none.
  std::optional<TakeSummary> known(const TwinTake& take) const;
  /// Writes the truth, the take and its summary, in this order, and deletes the devices' files.
  /// `number`: the index of the take in the plan. If there are motion files, every second take has
  /// the motion of a file on the body of the take's person.
  Result<TakeSummary> make(const TwinTake& take, std::size_t number, const Progress& progress);

 private:
  /// A motion, and the name that the truth gives it.
  struct Named {
    Motion motion;
    std::string name;
  };
  Result<Named> motion_of(const TwinTake& take, std::size_t number) const;
  // `length_s` includes the time of the clicks before the suit's first frame.
  Result<Motion> built_in(const TwinTake& take, double length_s) const;
  Result<Motion> carried(const TwinTake& take, double length_s, const std::string& file) const;
  double height_m(const TwinTake& take) const;

  TwinPlace place_;
  TakeMaker takes_;
};

}  // namespace kinalign
