// SPDX-License-Identifier: Apache-2.0
// Takes out of raw files: each manifest of a data set is aligned into the take beside it, unless
// that take was made of the same bytes with the same parameters already.
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

/// A share of the work: this process is one of `size`, from 0.
struct BuildShare {
  std::size_t rank = 0, size = 1;
};

struct BuildOptions {
  std::size_t jobs = 1;  // takes at once
  BuildShare share;
  bool all = false;  // also those that are up to date
};

enum class BuildReason { up_to_date, first, changed_parameters, changed_inputs, asked, no_summary };

struct BuildJob {
  TakeName name;
  std::uint64_t input_bytes = 0;
  BuildReason reason = BuildReason::first;
};

/// The takes that a share has to make, longest first.
struct BuildPlan {
  std::vector<BuildJob> jobs;
  std::size_t at_once = 1;       // takes
  std::uint64_t up_to_date = 0;  // takes of the share
};

struct Built {
  TakeName name;
  Result<TakeSummary> summary;
};

/// Callbacks of a build: its progress, and each finished take. Never called from two threads at
/// once.
struct BuildWatch {
  Progress progress;
  std::function<void(const Built&)> done;
};

/// Divides all takes among the shares, longest first, each to the share that has the least so far:
/// the same in every process. Those of the own share are compared with their manifests: by the
/// parameters, and by the inputs, whose bytes are hashed only where one is newer than the summary.
Result<BuildPlan> plan_build(FileSystem& files, const std::string& folder,
                             const Catalogue& catalogue, const BuildOptions& options,
                             const Progress& progress);

/// Makes takes and their summaries; each file appears as a whole. A take that fails stops no other.
/// Fails where the user stops it.
Result<void> build(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                   const BuildPlan& plan, const BuildWatch& watch);

/// Aligns raw files into takes of one data set. Several threads may make takes at once.
class TakeMaker {
 public:
  /// Both must outlive it.
  TakeMaker(FileSystem& files, const std::string& folder) : files_(files), folder_(folder) {}

  /// Writes the take and its summary; each file appears as a whole, in place of an older one.
  /// `base` ("" or ending in '/') is the folder of the manifest's paths; subject and action are the
  /// manifest's.
  Result<TakeSummary> make(const TakeName& name, const Manifest& manifest, const std::string& base,
                           const Progress& progress);

 private:
  FileSystem& files_;
  const std::string& folder_;
  std::mutex hdf5_;  // the library is not safe to use from several threads
};

/// The manifest of a take as it is aligned: with what dataset.toml says of [align], and with the
/// subject and the action of the take's name.
Result<Manifest> take_manifest(FileSystem& files, const std::string& folder,
                               const Catalogue& catalogue, const TakeName& name);

}  // namespace kinalign
