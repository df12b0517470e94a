// SPDX-License-Identifier: Apache-2.0
// Makes takes from raw files: the files that a manifest names are aligned into its take. A take is
// not made again if it was made from the same bytes with the same parameters.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/dataset/take_summary.h"
#include "kinalign/take/report.h"

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace kinalign {

/// A share of the work: this process is number `rank` of `size`, from 0.
struct BuildShare {
  std::size_t rank = 0, size = 1;
};

/// The choices of the user for one build.
struct BuildOptions {
  std::size_t jobs = 1;  // takes made at once
  BuildShare share;
  bool all = false;  // also make takes that are up to date
};

/// The reason why a take is made: its first time, a change, a request, or a missing summary.
enum class BuildReason { up_to_date, first, changed_parameters, changed_inputs, asked, no_summary };

/// One take to make. The size of its inputs decides its place in the order and its share of the
/// progress.
struct BuildJob {
  TakeName name;
  std::uint64_t input_bytes = 0;
  BuildReason reason = BuildReason::first;
};

/// The takes that this process has to make, longest first.
struct BuildPlan {
  std::vector<BuildJob> jobs;
  std::size_t at_once = 1;       // takes
  std::uint64_t up_to_date = 0;  // takes of the share
};

/// A finished take: its summary, or the reason why it failed.
struct Built {
  TakeName name;
  Result<TakeSummary> summary;
};

/// The callbacks of a build: its progress, and each finished take. They are never called from two
/// threads at once.
struct BuildWatch {
  Progress progress;
  std::function<void(const Built&)> done;
};

/// Divides all takes among the processes: the longest take first, each to the process with the
/// least work so far. Every process gets the same result. The takes of this process are then
/// compared with their manifests: by the parameters, and by the inputs. Inputs are hashed only if
/// one of them is newer than the summary.
Result<BuildPlan> plan_build(FileSystem& files, const std::string& folder,
                             const Catalogue& catalogue, const BuildOptions& options,
                             const Progress& progress);

/// Makes takes and their summaries; each file appears only when it is complete. A take that fails
/// does not stop others. Fails if the user stops the build.
Result<void> build(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                   const BuildPlan& plan, const BuildWatch& watch);

/// Aligns raw files into takes of one data set. Several threads may make takes at once.
class TakeMaker {
 public:
  /// Both arguments must outlive this object.
  TakeMaker(FileSystem& files, const std::string& folder) : files_(files), folder_(folder) {}

  /// Writes the take and its summary; each file replaces an older one only when it is complete.
  /// `base` ("" or ending in '/') is the folder to which the manifest's paths are relative. Subject
  /// and action are those of the manifest.
  Result<TakeSummary> make(const TakeName& name, const Manifest& manifest, const std::string& base,
                           const Progress& progress);

 private:
  FileSystem& files_;
  const std::string& folder_;
  std::mutex hdf5_;  // HDF5 may be used by one thread at a time
};

/// The manifest that a take is aligned with: the take's own manifest, with the options [align] of
/// dataset.toml, and with the subject and action of the take's name.
Result<Manifest> take_manifest(FileSystem& files, const std::string& folder,
                               const Catalogue& catalogue, const TakeName& name);

}  // namespace kinalign
