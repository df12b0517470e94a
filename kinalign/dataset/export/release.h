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
/// or a hardware address (in a citation and a licence only the addresses); serial numbers of
/// devices. Warnings: free text about a person, and other ids that look like names. Notes: a height
/// or weight that only one person has. `file`: the dataset.toml.
Findings look_for_people(const Catalogue& catalogue, const std::string& file,
                         const std::set<std::string>& names);

/// Removes names of files and marks from a take: `kinect.csv` replaces the name of the device's
/// file. Names occur in inputs, parameters and findings. Texts that select rows of a table are
/// emptied.
void hide_names(TakeHeader& header, AlignmentReport& report);

/// Moves the report's grid by the same time as the rows. Stamps of each stream count from its own
/// first one: they may be on the device's clock, and would then show by how much the rows moved.
void move_dates(Duration moved, TakeHeader& header, AlignmentReport& report);

/// A dataset.toml with the known facts, without comments and unknown keys, and without subjects
/// that are not in `used`.
std::string released_catalogue(Catalogue catalogue, const std::set<std::string>& used);

}  // namespace kinalign
