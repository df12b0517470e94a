// SPDX-License-Identifier: Apache-2.0
// Whether a data set is whole and what it says it is.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/catalogue.h"

#include <cstdint>
#include <string>

namespace kinalign {

struct VerifyOptions {
  std::size_t jobs = 1;
  bool deep = false;  // also every row of the takes (contents.h) and every byte of the raw files
};

struct Verified {
  std::uint64_t takes = 0, bytes = 0;  // of takes and, deep, of raw files
  Findings findings;                   // by severity, then by place; files below the folder
};

/// By severity, then by place.
void sort_findings(Findings& findings);

/// Reads every byte of the takes. Errors: a take that can't be read, whose hash is another, or
/// whose summary does not follow from it; a manifest without a take. Warnings: raw files that are
/// gone or others, parameters that have changed since, people and actions that dataset.toml does
/// not know. Notes: metadata that are not said, and files of which nobody knows. A
/// sourcedata folder that can't be read is a warning.
Result<Verified> verify(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                        const VerifyOptions& options, const Progress& progress);

}  // namespace kinalign
