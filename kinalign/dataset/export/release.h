// SPDX-License-Identifier: Apache-2.0
// Finds texts of a data set that could identify a person, and hides names and dates.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/catalogue.h"
#include "kinalign/take/report.h"
#include "kinalign/take/take.h"

#include <set>
#include <string>

namespace kinalign {

/// Checks the texts and ids of dataset.toml and the `names` of streams and nodes. Errors: ids of
/// subjects that look like names; texts and ids with a date, an e-mail address, a telephone number
/// or a hardware address; serial numbers of devices. In a citation and a licence only the addresses
/// are errors. Warnings: free text about a person, and other ids that look like names. Notes: a
/// height or weight that only one person has. `file`: the path of dataset.toml.
Findings look_for_people(const Catalogue& catalogue, const std::string& file,
                         const std::set<std::string>& names);

/// Removes file names and marks from a take. The name of a device's file becomes STREAM.ENDING, for
/// example `kinect.csv`, in inputs, parameters and findings. Texts that select rows of a table
/// become empty.
void hide_names(TakeHeader& header, AlignmentReport& report);

/// Moves the grid of the report by the same time as the rows. The stamps of each stream are counted
/// from its first stamp: they may be on the device's clock, and would then show by how much the
/// rows moved.
void move_dates(Duration moved, TakeHeader& header, AlignmentReport& report);

/// A dataset.toml with the known facts, without comments and unknown keys, and without subjects
/// that are not in `used`.
std::string released_catalogue(Catalogue catalogue, const std::set<std::string>& used);

}  // namespace kinalign
