// SPDX-License-Identifier: Apache-2.0
// Checks whether a data set is complete and consistent.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/catalogue.h"

#include <cstdint>
#include <string>

namespace kinalign {

/// How thorough the check is. The option `jobs` has no influence on the result.
struct VerifyOptions {
  std::size_t jobs = 1;
  bool deep = false;  // also check every row of the takes (contents.h) and every byte of raw files
};

/// The outcome of a check that was not stopped.
struct Verified {
  std::uint64_t takes = 0, bytes = 0;  // bytes of takes and, if `deep`, of raw files
  Findings findings;  // sorted by severity, then by path; paths are below the data set's folder
};

/// Sorts by severity, then by path.
void sort_findings(Findings& findings);

/// Reads every byte of the takes. Errors: a take that can't be read, has another hash, or does not
/// agree with its summary; a manifest without a take. Warnings: raw files that are missing or
/// changed, changed parameters, people and actions that dataset.toml lacks, a sourcedata folder
/// that can't be read. Notes: missing metadata, and unknown files.
Result<Verified> verify(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                        const VerifyOptions& options, const Progress& progress);

}  // namespace kinalign
